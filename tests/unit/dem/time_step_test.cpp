#include "dem/timestep.h"

#include <gtest/gtest.h>

#include <cmath>

#include "base/error.h"
#include "scenes/scene.h"

namespace trackbed {
namespace {

using scenes::Setting;

double step_of(Simulation& sim) {
  sim.changed();
  return stable_step(sim.model, sim.state, sim.work).dt;
}

double mass_of(const Setting& s) {
  return s.density * 4.0 / 3.0 * M_PI * std::pow(s.radius, 3);
}

// In touch with the plane or not: one contact of the stiffest kind at the farthest point, I = 2/5 m R^2.
TEST(StableStep, BallOnAPlane) {
  Setting a;
  a.ks = 5e5;
  const double expected = 0.8 * std::sqrt(0.4 * mass_of(a) / a.kn);
  for (double height : {0.03, 0.02 - 1e-6}) {
    Simulation sim = scenes::make_scene(a);
    scenes::add_plane(sim, Vec3::Zero(), Vec3::UnitZ());
    scenes::add_ball(sim, {0, 0, height});
    EXPECT_NEAR(step_of(sim) / expected, 1, 1e-12) << height;
  }
}

// Walls alone have no stable step: a step without end would leave them nowhere.
TEST(StableStep, NothingThatAStepCouldFollow) {
  Simulation sim = scenes::make_scene({});
  scenes::add_plane(sim, Vec3::Zero(), Vec3::UnitZ());
  EXPECT_THROW(sim.step(), RunError);
}

// Dashpots of ratio b: (sqrt(1 + d^2) - d)/omega with d = b sqrt(m R^2/I) of the turning ball.
TEST(StableStep, BallWithDashpots) {
  Setting a;
  a.dashpot = {0.2, 0.05, DashpotMode::full};
  Simulation sim = scenes::make_scene(a);
  scenes::add_ball(sim, Vec3::Zero());
  const double d = 0.2 * std::sqrt(2.5);
  const double expected = 0.8 * std::sqrt(0.4 * mass_of(a) / a.kn) * (std::sqrt(1 + d * d) - d);
  EXPECT_NEAR(step_of(sim) / expected, 1, 1e-12);
}

/// 27 balls that overlap by 1 um; the one in the middle touches six.
Simulation cubic_lattice(const Setting& a) {
  Simulation sim = scenes::make_scene(a);
  const double d = 2 * a.radius - 1e-6;
  for (int x = -1; x <= 1; ++x)
    for (int y = -1; y <= 1; ++y)
      for (int z = -1; z <= 1; ++z) scenes::add_ball(sim, d * Vec3(x, y, z));
  return sim;
}

TEST(StableStep, SimpleCubicLattice) {
  constexpr int middle = 13;
  Setting a;
  const double m = mass_of(a), lever = a.radius - 0.5e-6;
  a.ks = 2.5e5;  // the shift limits: 2 kn + 4 ks
  Simulation soft = cubic_lattice(a);
  EXPECT_NEAR(step_of(soft) / (0.8 * std::sqrt(m / (2 * a.kn + 4 * a.ks))), 1, 1e-12);
  EXPECT_EQ(stable_step(soft.model, soft.state, soft.work).clump, middle);
  a.ks = 1e6;  // the turn limits: 4 ks L^2
  Simulation stiff = cubic_lattice(a);
  const double inertia = 0.4 * m * a.radius * a.radius;
  EXPECT_NEAR(step_of(stiff) / (0.8 * std::sqrt(inertia / (4 * a.ks * lever * lever))), 1, 1e-12);

  const DiagonalStiffness k = stiffness_of(stiff.model, stiff.state, stiff.work, middle);
  for (int axis = 0; axis < 3; ++axis) {
    EXPECT_NEAR(k.shift[axis] / 6e6, 1, 1e-12);
    EXPECT_NEAR(k.turn[axis] / (4e6 * lever * lever), 1, 1e-12);
    EXPECT_EQ(k.viscous_shift[axis], 0);
  }
}

TEST(StableStep, RollingSpringsCount) {
  constexpr int middle = 13;
  Setting a;
  a.law = LawKind::linear_rolling;
  a.rolling_friction = 0.1;
  Simulation sim = cubic_lattice(a);
  const double lever = a.radius - 0.5e-6, effective = a.radius / 2;
  sim.changed();
  const double expected = 4 * a.ks * (lever * lever + effective * effective);
  EXPECT_NEAR(stiffness_of(sim.model, sim.state, sim.work, middle).turn.x() / expected, 1, 1e-12);
}

TEST(StableStep, KinematicLimit) {
  Setting a;
  Simulation sim = scenes::make_scene(a);
  scenes::add_ball(sim, Vec3::Zero(), {30, 0, 40});
  EXPECT_NEAR(step_of(sim) / (0.02 * a.radius / 50), 1, 1e-12);
  EXPECT_TRUE(stable_step(sim.model, sim.state, sim.work).is_kinematic);
  set_motion(sim.state, 0, {0, 3, 0}, {0, 0, 2000});  // its skin moves at 43 m/s
  EXPECT_NEAR(step_of(sim) / (0.02 * a.radius / 43), 1, 1e-12);
}

// A body that touches nothing may be met within the step.
TEST(StableStep, BodiesHaveAFloor) {
  Simulation sim = scenes::make_scene({});
  const double mass = 1e-3, side = 0.02;
  const Vec3 inertia = Vec3::Constant(mass * side * side / 6);
  const WallShape cube = make_mesh_wall("cube", box_mesh(Vec3::Constant(side), Vec3::Constant(-side / 2)));
  add_wall(sim, {cube, 0, BodyProperties{mass, inertia, {}, {}}}, {});
  sim.model.walls[0].body->free_shift = {true, true, true};
  scenes::add_ball(sim, {0, 0, 1});
  EXPECT_NEAR(step_of(sim) / (0.8 * std::sqrt(mass / 1e6)), 1, 1e-12);
  EXPECT_EQ(stable_step(sim.model, sim.state, sim.work).clump, -1);
  sim.model.walls[0].body->free_turn = {true, true, true};
  const double reach2 = 0.75 * side * side;
  EXPECT_NEAR(step_of(sim) / (0.8 * std::sqrt(inertia.x() / (1e6 * reach2))), 1, 1e-12);
  sim.state.walls[0].present = false;
  EXPECT_NEAR(step_of(sim) / (0.8 * std::sqrt(0.4 * mass_of({}) / 1e6)), 1, 1e-12);
}

TEST(NextStep, GrowsSlowlyAndRefusesAStepAboveTheStableOne) {
  Simulation sim = scenes::make_scene({});
  scenes::add_ball(sim, Vec3::Zero());
  const double stable = step_of(sim);
  sim.state.dt = stable / 100;
  EXPECT_NEAR(plan_steps(sim.model, sim.state, sim.work).dt / (stable / 100 * std::pow(1.05, 20)), 1, 1e-12);
  sim.model.time_step.fixed = 0.99 * stable;
  EXPECT_EQ(plan_steps(sim.model, sim.state, sim.work).dt, 0.99 * stable);
  sim.model.time_step.fixed = 1.01 * stable;
  EXPECT_THROW(plan_steps(sim.model, sim.state, sim.work), RunError);
}

/// A plate of 10 x 10 pebbles with dashpots of ratio 0.3 lies on a plane and is struck: its largest speed
/// from 10 ms on, over that of the stroke.
double motion_after_stroke(double safety) {
  Setting a;
  a.dashpot = {0.3, 0.3, DashpotMode::full};
  a.gravity = {0, 0, -9.81};
  Simulation sim = scenes::make_scene(a);
  sim.model.time_step.safety = safety;
  std::vector<Pebble> pebbles;
  for (int k = 0; k < 100; ++k) pebbles.push_back({{0.01 * (k % 10 - 4.5), 0.01 * (k / 10 - 4.5), 0}, 0.005});
  const double volume = 0.1 * 0.1 * 0.01;
  sim.model.templates.push_back(
      make_clump_template("plate", pebbles, volume, volume / 12 * Vec3(1.01e-2, 1.01e-2, 2e-2)));
  scenes::add_plane(sim, Vec3::Zero(), Vec3::UnitZ());
  scenes::add_ball(sim, {0, 0, 0.005 - 1e-6}, {0.05, 0, -0.1}, Vec3::Zero(), 1, 1);
  sim.changed();
  EXPECT_EQ(sim.work.touching, 100);
  double largest = 0;
  scenes::run_until(sim, 0.05, [&] {
    if (sim.state.time > 0.01) largest = std::max(largest, sim.state.clumps.velocity[0].norm());
    return false;
  });
  return largest / 0.1;
}

// A hundred dashpots of ratio 0.3 are three times critical for the stone.
TEST(StableStep, ManyDashpotsStayStable) {
  EXPECT_LT(motion_after_stroke(0.8), 0.1);
  // With six times the step, which is what its springs alone would allow, it blows up.
  EXPECT_THROW(motion_after_stroke(0.8 * (std::sqrt(10.0) + 3)), RunError);
}

}  // namespace
}  // namespace trackbed
