// Clumps in one part of a bed, balls in the other.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <set>

#include "lab/measures/measures.h"
#include "lab/run.h"

namespace trackbed {
namespace {

constexpr const char* two_layers = R"toml(
title = "Clumps below, balls above"
seed = 5
[stones]
shapes = 4
distance = "110 deg"
ratio = 0.5
[stones.grading]
sieves = ["20 mm", "30 mm"]
passing = ["0 %", "100 %"]
[stones.sets.stand_in]
fidelity = "stand_in"
[stones.sets.ball]
fidelity = "ball"
[materials.ballast]
kn = "1e6 N/m"
ks = "1e6 N/m"
friction = 0.5
density = "2630 kg/m^3"
[walls.box]
kind = "box"
size = ["200 mm", "200 mm", "200 mm"]
material = "ballast"
[walls.lid]
kind = "plane"
point = ["0 mm", "0 mm", "200 mm"]
normal = [0, 0, -1]
material = "ballast"
[regions.low]
kind = "box"
below = "80 mm"
[[stages]]
kind = "scatter"
name = "clumps"
set = "stand_in"
region = "low"
porosity = 0.35
[[stages]]
kind = "scatter"
name = "balls"
set = "ball"
region = "low"
outside = true
porosity = 0.45
[[stages]]
kind = "replace"
region = "low"
)toml";

class TwoFidelities : public testing::Test {
 protected:
  void SetUp() override {
    const Document document = Document::from_text(two_layers, "two-layers.toml", {});
    CaseInput input;
    document.read(input);
    sim = make_simulation(document, input);
    stages = stages_of(input);
  }
  bool is_of(const std::string& set, std::size_t stone) const {
    const StoneSet& s = sim.stone_set(set);
    const int shape = sim.state.clumps.shape[stone];
    return shape >= s.first && shape < s.first + s.count;
  }
  Simulation sim;
  std::vector<NamedStage> stages;
};

TEST_F(TwoFidelities, EachPartHasItsPorosity) {
  const double largest = std::numbers::pi / 6 * std::pow(0.03, 3);  // stone [m^3]
  carry_out(sim, *stages[0].stage);
  EXPECT_NEAR(solid_volume(sim), 0.65 * 0.2 * 0.2 * 0.08, largest);
  carry_out(sim, *stages[1].stage);
  EXPECT_NEAR(solid_volume(sim), 0.65 * 0.2 * 0.2 * 0.08 + 0.55 * 0.2 * 0.2 * 0.12, 2 * largest);
}

TEST_F(TwoFidelities, AStandInHasThePebblesOfItsClumpInOneAndWeighsTheSame) {
  const StoneSet &clumps = sim.stone_set(""), &balls = sim.stone_set("stand_in");
  ASSERT_EQ(clumps.count, balls.count);
  for (int k = 0; k < clumps.count; ++k) {
    const ClumpTemplate& clump = sim.model.templates[static_cast<std::size_t>(clumps.first + k)];
    const ClumpTemplate& ball = sim.model.templates[static_cast<std::size_t>(balls.first + k)];
    ASSERT_EQ(ball.pebbles.size(), 1u);
    EXPECT_NEAR(4.0 / 3.0 * std::numbers::pi * std::pow(ball.pebbles[0].radius, 3) / clump.pebble_volume, 1,
                1e-12);
    EXPECT_LT(clump.pebble_volume, 0.95 * clump.volume);  // so that there is something to stand in for
    EXPECT_EQ(ball.volume, clump.volume);
  }
}

TEST_F(TwoFidelities, OnlyStonesInTheRegionAreReplacedAndNoneChangesItsMass) {
  carry_out(sim, *stages[0].stage);
  carry_out(sim, *stages[1].stage);
  std::set<int> low;  // ids of those that must become clumps
  std::vector<double> mass_of(sim.state.clumps.id.size());
  for (std::size_t k = 0; k < mass_of.size(); ++k) {
    mass_of[static_cast<std::size_t>(sim.state.clumps.id[k])] = sim.state.clumps.mass[k];
    if (sim.state.clumps.position[k].z() < 0.08) low.insert(sim.state.clumps.id[k]);
  }
  carry_out(sim, *stages[2].stage);
  std::size_t replaced = 0;
  for (std::size_t k = 0; k < mass_of.size(); ++k) {
    const int id = sim.state.clumps.id[k];
    EXPECT_NEAR(sim.state.clumps.mass[k] / mass_of[static_cast<std::size_t>(id)], 1, 1e-12);
    EXPECT_EQ(is_of("", k), low.contains(id)) << id;
    replaced += low.contains(id);
  }
  EXPECT_GT(replaced, 100u);
  EXPECT_LT(replaced, mass_of.size() - 100);
}

}  // namespace
}  // namespace trackbed
