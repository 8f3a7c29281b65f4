// Particle replacement and radius adjustment: balls, then clumps of the same volumes in their place.
#include <gtest/gtest.h>

#include <cmath>

#include "dem/touching.h"
#include "lab/case.h"
#include "lab/in_touch.h"
#include "lab/measures/measures.h"
#include "lab/run.h"

namespace trackbed {
namespace {

constexpr const char* bed = R"toml(
title = "Bed by replacement"
seed = 3
[stones]
shapes = 3
distance = "120 deg"
ratio = 0.5
[stones.sets.ball]
fidelity = "ball"
[materials.ballast]
kn = "1e6 N/m"
ks = "1e6 N/m"
friction = 0.5
density = "2630 kg/m^3"
[walls.box]
kind = "box"
size = ["250 mm", "250 mm", "150 mm"]
material = "ballast"
[walls.lid]
kind = "plane"
point = ["0 mm", "0 mm", "150 mm"]
normal = [0, 0, -1]
material = "ballast"
[record]
tables = false
picture = false
paraview_stones = "none"
[[stages]]
kind = "scatter"
set = "ball"
porosity = 0.45
[[stages]]
kind = "settle"
name = "balls"
[[stages]]
kind = "replace"
[[stages]]
kind = "adjust"
friction = 0.2
[[stages]]
kind = "remove"
walls = ["lid"]
[[stages]]
kind = "settle"
name = "rest"
)toml";

struct Bed {
  Simulation sim;
  std::vector<double> volumes;  // of the balls, by id [m^3]
  double factor = 1;            // by which sizes were changed

  Bed() {
    const Document document = Document::from_text(bed, "prra.toml", {});
    CaseInput input;
    document.read(input);
    sim = make_simulation(document, input);
    for (NamedStage& named : stages_of(input)) {
      const auto opened = [&] {
        if (named.name == "replace") look_at_balls();
      };
      for (const Result& r : carry_out(sim, *named.stage, opened))
        if (r.name == "factor") factor = r.value;
    }
  }

 private:
  // When the stage has opened, each stone has its new shape and the volume of the ball it was.
  void look_at_balls() {
    volumes.resize(sim.state.clumps.id.size());
    for (std::size_t k = 0; k < volumes.size(); ++k)
      volumes[static_cast<std::size_t>(sim.state.clumps.id[k])] = volume_of(sim, k);
  }
};

TEST(prra, leaves_a_bed_of_clumps_at_rest_with_the_volume_of_the_balls) {
  const Bed made;
  const Simulation& sim = made.sim;
  const Clumps& c = sim.state.clumps;
  ASSERT_GT(c.size(), 100);
  // The nominal porosity is that of the room, to the volume of one stone.
  double volume = 0;
  for (double v : made.volumes) volume += v;
  EXPECT_NEAR(volume, 0.55 * 0.25 * 0.25 * 0.15, 4.0 / 3.0 * M_PI * std::pow(0.0315, 3));
  for (std::size_t k = 0; k < c.id.size(); ++k) {
    EXPECT_GT(sim.model.templates[static_cast<std::size_t>(c.shape[k])].pebbles.size(), 1u);
    EXPECT_NEAR(volume_of(sim, k) / made.volumes[static_cast<std::size_t>(c.id[k])], std::pow(made.factor, 3),
                1e-9);
  }
  EXPECT_NEAR(made.factor, 1, 0.01);
  EXPECT_LT(unbalanced_ratio(sim.model, sim.state), 1e-3);
  // No stone was thrown over the rim, and walls and floor bear the weight.
  double lift = 0;
  for (const WallState& wall : sim.state.walls) lift -= wall.force.z();
  EXPECT_NEAR(lift / weight(sim), 1, 0.01);
  for (const Vec3& x : c.position) EXPECT_LT(x.z(), 0.15);
}

TEST(prra, mean_stress_is_that_of_the_walls) {
  // Without gravity the mean stress of stones in a closed box is the mean of the pressures on its walls, for
  // any bed at rest: sum of F x L over the contacts = sum over the walls of F x X.
  const Document document = Document::from_text(bed, "prra.toml", {});
  CaseInput input;
  document.read(input);
  Simulation sim = make_simulation(document, input);
  const auto stages = stages_of(input);
  carry_out(sim, *stages[0].stage);
  sim.model.gravity = Vec3::Zero();
  for (int k = 0; k < 20'000; ++k) sim.step();
  double by_walls = 0, by_contacts = 0;
  visit_touching(sim.model, sim.state, [&](const Touching& t) {
    if (t.clump_2 < 0) by_walls += t.force().dot(t.point);
  });
  const BedStress stress = bed_stress(sim);
  by_contacts = 3 * stress.mean * stress.volume;
  ASSERT_GT(by_contacts, 1e-3);
  EXPECT_NEAR(by_contacts / by_walls, 1, 1e-3);
}

}  // namespace
}  // namespace trackbed
