// Trays: filled together, shifted on each other under a load; and mixtures by mass.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "expected.h"
#include "lab/measures/measures.h"
#include "lab/room.h"
#include "scenes/temporary_folder.h"

namespace trackbed {
namespace {

constexpr const char* small_box = R"toml(
title = "A small shear box"
seed = 2
[stones]
shapes = 3
distance = "110 deg"
ratio = 0.5
material = "fresh"
[stones.grading]
sieves = ["14 mm", "20 mm"]
passing = ["0 %", "100 %"]
[stones.sets.heavy]
shapes = 3
distance = "110 deg"
ratio = 0.5
wear = 0.2
material = "heavy"
[stones.sets.stand_in]
fidelity = "stand_in"
material = "fresh"
[materials.fresh]
kn = "2e6 N/m"
ks = "2e6 N/m"
friction = 0.5
density = "2600 kg/m^3"
[materials.heavy]
kn = "2e6 N/m"
ks = "2e6 N/m"
friction = 0.5
density = "3900 kg/m^3"
[materials.steel]
kn = "2e7 N/m"
ks = "2e7 N/m"
friction = 0.2
[walls.lower]
kind = "tray"
size = ["150 mm", "120 mm", "60 mm"]
at = ["-15 mm", "0 mm", "0 mm"]
material = "steel"
[walls.upper]
kind = "tray"
size = ["120 mm", "120 mm", "80 mm"]
at = ["0 mm", "0 mm", "60 mm"]
floor = false
rim = "40 mm"
material = "steel"
[walls.top]
kind = "plane"
point = ["0 mm", "0 mm", "120 mm"]
normal = [0, 0, -1]
material = "steel"
[bodies.cover]
kind = "block"
size = ["118 mm", "118 mm", "20 mm"]
mass = "0.1 kg"
material = "steel"
free = ["z"]
[record]
every = "1 ms"
picture = false
tables = false
paraview_stones = "none"
[[stages]]
kind = "scatter"
set = "stand_in"
porosity = 0.45
[[stages]]
kind = "replace"
name = "mix"
set = "heavy"
share = 0.3
mean_overlap = 0.04
stiffness = 0.02
[[stages]]
kind = "replace"
name = "shapes"
from = "stand_in"
mean_overlap = 0.02
stiffness = 0.02
[[stages]]
kind = "insert"
body = "cover"
bottom = "120 mm"
at = ["0 mm", "0 mm"]
[[stages]]
kind = "remove"
walls = ["top"]
[[stages]]
kind = "load"
body = "cover"
force_max = "1 kN"
ramp = "30 ms"
duration = "60 ms"
[[stages]]
kind = "settle"
[[stages]]
kind = "move"
name = "shear"
wall = "lower"
velocity = ["40 mm/s", "0 mm/s", "0 mm/s"]
distance = "12 mm"
)toml";

class ShearBox : public testing::Test {
 protected:
  CaseInput read(const std::vector<std::string>& set = {}) {
    document_ = std::make_unique<Document>(Document::from_text(small_box, "box.toml", set));
    CaseInput in;
    document_->read(in);
    return in;
  }
  std::unique_ptr<Document> document_;
};

TEST_F(ShearBox, TheRoomIsThatOfBothTraysBelowTheLid) {
  const CaseInput in = read();
  const Simulation sim = make_simulation(*document_, in);
  const double volume = 0.15 * 0.12 * 0.06 + 0.12 * 0.12 * 0.06;
  EXPECT_NEAR(volume_in(sim.container, [&](const Vec3& x) { return is_in_room(sim, x); }) / volume, 1, 0.02);
  EXPECT_TRUE(is_in_room(sim, {-0.085, 0, 0.05}));   // in the longer, lower one
  EXPECT_FALSE(is_in_room(sim, {-0.085, 0, 0.07}));  // above its rim
  EXPECT_FALSE(is_in_room(sim, {0, 0, 0.125}));      // above the lid
}

TEST_F(ShearBox, long_AMixtureHasItsShareByMassWithinAStone) {
  for (const std::string share : {"0", "0.1", "0.5", "1"}) {
    const CaseInput in = read({"stages.mix.share=" + share});
    Simulation sim = make_simulation(*document_, in);
    for (NamedStage& named : stages_of(in)) {
      const std::vector<Result> results = carry_out(sim, *named.stage);
      if (named.name != "mix") continue;
      double heavy = 0, all = 0, heaviest = 0;
      for (std::size_t k = 0; k < sim.state.clumps.id.size(); ++k) {
        const double mass = sim.state.clumps.mass[k];
        const bool is_heavy = sim.state.clumps.material[k] == sim.find_material("heavy");
        const int place = sim.state.clumps.shape[k] - sim.stone_set("heavy").first;
        EXPECT_EQ(place >= 0 && place < sim.stone_set("heavy").count, is_heavy);
        heavy += is_heavy ? mass : 0;
        all += mass;
        heaviest = std::max(heaviest, mass);
      }
      EXPECT_NEAR(heavy / all, std::stod(share), 0.5 * heaviest / all + 1e-12);
      EXPECT_NEAR(value_of(results, "mass_share"), heavy / all, 1e-9);
      break;
    }
  }
}

// The load stays on the cover while the lower tray moves, no stone leaves the trays, and the forces of what
// moves and what stands balance.
TEST_F(ShearBox, long_IsShearedUnderALoadThatStays) {
  // Local damping acts on each stone against its motion as if from outside: with the usual 0.7 it bears 7 %
  // of the lower tray's force at this speed, with 0.2 3 %.
  const CaseInput in = read({"numerics.damping=0.05"});
  Simulation sim = make_simulation(*document_, in);
  const auto force = [&](const char* wall) {
    return sim.state.walls[static_cast<std::size_t>(sim.find_wall(wall))].force;
  };
  Vec3 lower = Vec3::Zero(), upper = Vec3::Zero(), cover = Vec3::Zero();  // means over the shear
  for (NamedStage& named : stages_of(in)) {
    if (named.name != "shear") {
      carry_out(sim, *named.stage);
      continue;
    }
    named.stage->open(sim);
    double sum = 0;
    int n = 0, away = 0;
    while (!named.stage->finished(sim)) {
      named.stage->control(sim);
      sim.step();
      const double bears = force("cover").z();
      sum += bears;
      away += std::abs(bears - 1001) > 0.05 * 1001;
      lower += force("lower"), upper += force("upper"), cover += force("cover");
      ++n;
    }
    lower /= n, upper /= n, cover /= n;
    EXPECT_NEAR(sum / n, 1001, 2);  // 1 kN and its weight of 0.98 N
    EXPECT_LT(away, n / 20);
    EXPECT_NEAR(value_of(named.stage->close(sim), "distance"), 0.012, 1e-4);
  }
  for (const Vec3& x : sim.state.clumps.position) EXPECT_TRUE(is_in_room(sim, x)) << x.transpose();
  // The lower tray drags the stones to the right, the upper one and the cover hold them back.
  EXPECT_LT(force("lower").x(), -300);
  EXPECT_GT(force("upper").x(), 0);
  EXPECT_NEAR(lower.x() + upper.x() + cover.x(), 0, 0.01 * std::abs(lower.x()));
  EXPECT_NEAR(lower.z() + upper.z() + cover.z() + weight(sim) - 0.981, 0, 0.02 * 1001);
}

TEST(direct_shear, long_short_form_gives_what_the_case_expects) {
  const TemporaryFolder out;
  const Summary summary = run_and_compare("direct-shear", out.path);
  const double load = 36e3 * 0.09 / 0.36;
  EXPECT_NEAR(value_of(stage_of(summary, "rest").measures, "cover.force_z"), load, 0.01 * load);
  EXPECT_NEAR(value_of(stage_of(summary, "mix").results, "mass_share"), 0.5, 0.01);
}

TEST(box_stiffness, long_short_form_gives_what_the_case_expects) {
  const TemporaryFolder out;
  const Summary summary = run_and_compare("box-stiffness", out.path);
  const StageSummary& press = stage_of(summary, "press");
  EXPECT_EQ(value_of(stage_of(summary, "plate").results, "removed"), 0);
  EXPECT_GE(value_of(press.results, "force_peak"), value_of(press.results, "force"));
  EXPECT_GT(value_of(press.results, "force_at_2_mm"), value_of(press.results, "force_at_1_mm"));
}

}  // namespace
}  // namespace trackbed
