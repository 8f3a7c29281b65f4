// Two dimensions: discs of a thickness, held in the plane y = 0, against closed forms.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "base/error.h"
#include "base/rng.h"
#include "lab/case.h"
#include "lab/measures/measures.h"
#include "lab/run.h"
#include "scenes/scene.h"

namespace trackbed {
namespace {

constexpr double g = 9.81, radius = 0.02, kn = 1e6, density = 2650;

Simulation plane_scene(double thickness, double friction = 0) {
  scenes::Setting setting;
  setting.friction = friction;
  Simulation sim = scenes::make_scene(setting);
  sim.model.space.thickness = thickness;
  sim.model.templates = {make_disc_template(radius, thickness)};
  return sim;
}

TEST(plane, a_disc_has_the_mass_and_inertia_of_its_thickness) {
  Simulation sim = plane_scene(0.7);
  const int disc = scenes::add_ball(sim, Vec3::Zero(), Vec3::Zero(), Vec3::Zero(), 1.5);
  const auto k = static_cast<std::size_t>(disc);
  const double r = 1.5 * radius, mass = density * std::numbers::pi * r * r * 0.7;
  EXPECT_NEAR(sim.state.clumps.mass[k] / mass, 1, 1e-14);
  EXPECT_NEAR(sim.state.clumps.inertia[k].y() / (0.5 * mass * r * r), 1, 1e-14);
  EXPECT_NEAR(equal_volume_radius(sim.model, sim.state.clumps, k) / r, 1, 1e-14);
  rescale(sim.model, sim.state, disc, 2.0);
  EXPECT_NEAR(sim.state.clumps.mass[k] / (4 * mass), 1, 1e-14);
  EXPECT_NEAR(sim.state.clumps.inertia[k].y() / (16 * 0.5 * mass * r * r), 1, 1e-14);
}

TEST(plane, a_disc_bounces_with_the_period_of_its_mass) {
  // Contact time pi sqrt(m/k), without damping the speed comes back whole.
  Simulation sim = plane_scene(0.5);
  scenes::add_plane(sim, Vec3::Zero(), Vec3::UnitZ());
  scenes::add_ball(sim, {0, 0, radius}, {0, 0, -0.1});
  const double mass = sim.state.clumps.mass[0], contact = std::numbers::pi * std::sqrt(mass / kn);
  sim.model.time_step.fixed = contact / 2000;
  sim.changed();
  double left = 0;
  scenes::run_until(sim, 2 * contact, [&] {
    if (sim.state.clumps.velocity[0].z() > 0 && sim.work.touching == 0) left = sim.state.time;
    return left > 0;
  });
  EXPECT_NEAR(left / contact, 1, 1e-3);
  EXPECT_NEAR(sim.state.clumps.velocity[0].z(), 0.1, 1e-6);
}

TEST(plane, a_disc_rolls_down_a_slope_with_two_thirds_of_its_pull) {
  // a = g sin / (1 + I/(m r^2)) with I = m r^2 / 2; a ball has 5/7.
  constexpr double slope = 0.3;
  Simulation sim = plane_scene(1.0, 0.5);
  sim.model.gravity = g * Vec3(std::sin(slope), 0, -std::cos(slope));
  scenes::add_plane(sim, Vec3::Zero(), Vec3::UnitZ());
  const double mass = sim.model.templates[0].volume * density;
  scenes::add_ball(sim, {0, 0, radius - mass * g * std::cos(slope) / kn});
  sim.changed();
  scenes::run_until(sim, 0.5);
  const double way = 0.5 * (2.0 / 3.0) * g * std::sin(slope) * 0.25;
  EXPECT_NEAR(sim.state.clumps.position[0].x() / way, 1, 2e-3);
  EXPECT_NEAR(sim.state.clumps.angular_velocity[0].y() * radius / sim.state.clumps.velocity[0].x(), 1, 1e-2);
}

constexpr const char* discs_in_a_box = R"toml(
title = "Discs in a box"
thickness = "0.5 m"
[stones]
fidelity = "ball"
[contact]
law = "linear_rolling"
[materials.ballast]
kn = "1e7 N/m"
ks = "1e7 N/m"
friction = 0.5
rolling_friction = 0.2
density = "2630 kg/m^3"
[walls.box]
kind = "box"
size = ["0.5 m", "0.5 m", "0.3 m"]
material = "ballast"
[bodies.sleeper]
kind = "block"
size = ["0.15 m", "0.5 m", "0.1 m"]
mass = "100 kg"
material = "ballast"
[[stages]]
kind = "fill"
porosity = 0.2
density = 0.3
[[stages]]
kind = "settle"
[[stages]]
kind = "insert"
body = "sleeper"
[[stages]]
kind = "hold"
duration = "0.3 s"
[[stages]]
kind = "settle"
name = "rest"
)toml";

/// After all stages, or those before the one that is named.
Simulation ran(const char* text, const std::vector<std::string>& set = {}, const std::string& before = "") {
  const Document document = Document::from_text(text, "plane.toml", set);
  CaseInput input;
  document.read(input);
  Simulation sim = make_simulation(document, input);
  for (NamedStage& stage : stages_of(input)) {
    if (stage.name == before) break;
    carry_out(sim, *stage.stage);
  }
  return sim;
}

double area_of(const Simulation& sim) {
  double area = 0;
  for (const double scale : sim.state.clumps.scale) area += std::numbers::pi * std::pow(scale * radius, 2);
  return area;
}

TEST(plane, a_bed_under_a_sleeper_stays_in_the_plane_and_weighs_what_it_weighs) {
  const Simulation sim = ran(discs_in_a_box);
  const Clumps& c = sim.state.clumps;
  ASSERT_GT(c.size(), 40);
  for (std::size_t k = 0; k < c.id.size(); ++k) {
    EXPECT_EQ(c.position[k].y(), 0) << k;
    EXPECT_EQ(c.velocity[k].y(), 0) << k;
    EXPECT_EQ(c.angular_momentum[k].x(), 0) << k;
    EXPECT_EQ(c.angular_momentum[k].z(), 0) << k;
  }
  const double area = area_of(sim), filled = area_of(ran(discs_in_a_box, {}, "insert"));
  EXPECT_NEAR(filled / (0.8 * 0.5 * 0.3), 1, 0.02);  // a stone is 1 to 2 %
  EXPECT_LE(area, filled);
  EXPECT_GT(area / filled, 0.94);  // the sleeper took a few away
  EXPECT_NEAR(solid_volume(sim) / (0.5 * area), 1, 1e-12);
  const WallState& sleeper = sim.state.walls[static_cast<std::size_t>(sim.find_wall("sleeper"))];
  EXPECT_EQ(sleeper.pose.position.y(), 0);
  EXPECT_NEAR(sleeper.force.z() / (100 * g), 1, 0.01);
  double lift = 0;
  for (const char* name : {"box.floor", "box.left", "box.right"})
    lift -= sim.state.walls[static_cast<std::size_t>(sim.find_wall(name))].force.z();
  EXPECT_NEAR(lift / weight(sim), 1, 0.01);
  EXPECT_EQ(sim.find_wall("box.front"), -1);
}

TEST(plane, forces_are_those_of_the_thickness) {
  // Twice the thickness, with twice the stiffness and the sleeper's mass: the same motion, twice the forces.
  const Simulation one = ran(discs_in_a_box),
                   two = ran(discs_in_a_box,
                             {"thickness=1 m", "materials.ballast.kn=2e7 N/m", "materials.ballast.ks=2e7 N/m",
                              "bodies.sleeper.mass=200 kg", "walls.box.size=[\"0.5 m\", \"1 m\", \"0.3 m\"]",
                              "bodies.sleeper.size=[\"0.15 m\", \"1 m\", \"0.1 m\"]"});
  ASSERT_EQ(one.state.clumps.size(), two.state.clumps.size());
  EXPECT_NEAR(two.state.walls[0].force.z() / one.state.walls[0].force.z(), 2, 0.02);
}

TEST(plane, mean_stress_is_that_of_the_walls) {
  // Four discs in a square of walls, each pressed by the same amount. For any bodies at rest the trace of the
  // mean stress x volume is the sum over the walls of F x, here at the middles of the overlaps.
  Simulation sim = plane_scene(0.5);
  sim.model.gravity = Vec3::Zero();
  constexpr double overlap = 1e-4, half = 2 * radius - 1.5 * overlap;
  for (const Vec3& side : {Vec3(1, 0, 0), Vec3(-1, 0, 0), Vec3(0, 0, 1), Vec3(0, 0, -1)})
    scenes::add_plane(sim, -half * side, side);
  for (const double x : {-1.0, 1.0})
    for (const double z : {-1.0, 1.0})
      scenes::add_ball(sim, {x * (radius - overlap / 2), 0, z * (radius - overlap / 2)});
  sim.container = {Vec3(-half, -0.25, -half), Vec3(half, 0.25, half)};
  sim.changed();
  const double force = sim.state.walls[0].force.norm();
  ASSERT_NEAR(force, 2 * kn * overlap, 1e-9);
  const BedStress stress = bed_stress(sim);
  EXPECT_NEAR(2 * stress.mean * stress.volume / (4 * force * (half + overlap / 2)), 1, 1e-9);
}

void expect_refused(const std::vector<std::string>& set, const std::string& told) {
  try {
    ran(discs_in_a_box, set);
    FAIL() << told;
  } catch (const InputError& error) {
    EXPECT_NE(std::string(error.what()).find(told), std::string::npos) << error.what();
  }
}

TEST(plane, what_does_not_lie_in_it_is_refused) {
  expect_refused({"stones.fidelity=clump"}, "stones of a model with a thickness are discs");
  expect_refused({"thickness=0.4 m"}, "the container goes from -0.25 to 0.25 m along y");
  expect_refused({"bodies.sleeper.size=[\"0.15 m\", \"0.3 m\", \"0.1 m\"]"}, "sleeper is 0.3 m wide along y");
  expect_refused({"numerics.gravity=[\"0 m/s^2\", \"1 m/s^2\", \"-9 m/s^2\"]"}, "out of the plane y = 0");
  expect_refused({"walls.lid={kind=\"plane\", normal=[0, 1, -1], material=\"ballast\"}"},
                 "does not stand on the plane");
}

}  // namespace
}  // namespace trackbed
