// Differential density scaling: rest is where it was, and is reached in fewer steps.
#include <gtest/gtest.h>

#include <cmath>

#include "base/rng.h"
#include "dem/inspect.h"
#include "scenes/scene.h"

namespace trackbed {
namespace {

using scenes::Setting;

Setting setting() {
  Setting a;
  a.damping = 0.7;
  a.gravity = {0, 0, -9.81};
  return a;
}

/// Steps until the stones are at rest; returns how many that took.
int settle(Simulation& sim, double ratio) {
  for (int steps = 1; steps < 1'000'000; ++steps) {
    sim.step();
    if (steps % 50 == 0 && unbalanced_ratio(sim.model, sim.state) < ratio) return steps;
  }
  ADD_FAILURE() << "not at rest: " << unbalanced_ratio(sim.model, sim.state);
  return 0;
}

double floor_force(const Simulation& sim) {
  return -sim.state.walls[0].force.z();
}

/// Large balls on a plane, and on every other one a ball of a third of its size.
Simulation pile() {
  Simulation sim = scenes::make_scene(setting());
  scenes::add_plane(sim, Vec3::Zero(), Vec3::UnitZ());
  for (int k = 0; k < 8; ++k) {
    scenes::add_ball(sim, {0.07 * k, 0, 0.03}, Vec3::Zero(), Vec3::Zero(), 1.5);
    if (k % 2 == 0) scenes::add_ball(sim, {0.07 * k, 0, 0.07}, Vec3::Zero(), Vec3::Zero(), 0.5);
  }
  sim.changed();
  return sim;
}

TEST(scaled_step, a_ball_on_a_plane_sinks_in_by_its_weight_over_the_stiffness) {
  Simulation sim = scenes::make_scene(setting());
  scenes::add_plane(sim, Vec3::Zero(), Vec3::UnitZ());
  for (const double scale : {0.5, 1.0, 2.0}) scenes::add_ball(sim, {scale, 0, 0.02 * scale}, {}, {}, scale);
  sim.scale_step();
  sim.changed();
  settle(sim, 1e-11);
  const Clumps& c = sim.state.clumps;
  for (std::size_t k = 0; k < 3; ++k)
    EXPECT_NEAR((0.02 * c.scale[k] - c.position[k].z()) / (c.mass[k] * 9.81 / 1e6), 1, 1e-9) << k;
}

TEST(scaled_step, a_stack_bears_the_same_forces_in_fewer_steps) {
  Simulation plain = pile(), scaled = pile();
  scaled.scale_step();
  const int many = settle(plain, 1e-12), few = settle(scaled, 1e-12);
  EXPECT_LT(few, many);
  EXPECT_NEAR(floor_force(scaled) / floor_force(plain), 1, 1e-9);
  for (std::size_t k = 0; k < scaled.state.clumps.id.size(); ++k)
    EXPECT_NEAR((scaled.state.clumps.position[k] - plain.state.clumps.position[k]).norm(), 0, 1e-12) << k;
}

TEST(scaled_step, only_stones_with_a_short_step_get_more_inertia_and_all_lose_it_again) {
  Simulation sim = pile();
  const std::vector<double> masses = sim.state.clumps.mass;
  const std::vector<Vec3> inertias = sim.state.clumps.inertia;
  const Conditions before = sim.model;
  sim.scale_step();
  for (int k = 0; k < 400; ++k) sim.step();
  const Clumps& c = sim.state.clumps;
  EXPECT_EQ(c.mass, masses);
  for (std::size_t k = 0; k < c.id.size(); ++k) {
    if (c.scale[k] < 1)
      EXPECT_GT(c.inertial_mass[k], 2 * c.mass[k]) << k;
    else
      EXPECT_LT(c.inertial_mass[k], 1.5 * c.mass[k]) << k;
    EXPECT_GE(c.inertial_mass[k], c.mass[k]) << k;
  }
  sim.restore(before);
  EXPECT_EQ(c.inertial_mass, masses);
  EXPECT_EQ(c.inertia, inertias);
  for (const Vec3& v : c.velocity) EXPECT_TRUE(v.isZero(0));
}

/// Lowers a lid that just touches the small balls of the pile at 1 mm/s for a millimetre; returns its force
/// [N] and counts the steps.
double press(bool scaled, int& steps, EnergyBalance& balance) {
  Simulation sim = pile();
  const int lid = scenes::add_plane(sim, {0, 0, 0.08}, -Vec3::UnitZ());
  sim.changed();
  settle(sim, 1e-10);
  if (scaled) sim.scale_step();
  sim.drive(static_cast<std::size_t>(lid), {0, 0, -1e-3});
  const double start = sim.state.time;
  const EnergyBalance before = energy_of(sim.model, sim.state);
  for (steps = 0; sim.state.time - start < 1; ++steps) sim.step();
  balance = energy_of(sim.model, sim.state);
  EXPECT_LT(std::abs(balance.total() - before.total()),
            1e-4 * (balance.boundary_work - before.boundary_work));
  const WallState& wall = sim.state.walls[static_cast<std::size_t>(lid)];
  return wall.force.z() / (0.08 - wall.pose.position.z());
}

// Slow pressing asks of stones what rest does: inertia has no part in it.
TEST(scaled_step, a_slow_press_meets_the_same_force_in_fewer_steps) {
  int many = 0, few = 0;
  EnergyBalance plain, scaled;
  const double expected = press(false, many, plain), found = press(true, few, scaled);
  EXPECT_LT(few, 0.7 * many);
  EXPECT_NEAR(expected / (4 * 1e6 / 3), 1, 1e-2);  // four stacks of three contacts
  EXPECT_NEAR(found / expected, 1, 1e-3);          // the rest is what inertia asks for at this speed
  EXPECT_NEAR(scaled.boundary_work / plain.boundary_work, 1, 1e-3);
}

// What the stones lose as their inertia changes counts as damped: the balance of a fall into rest closes.
TEST(scaled_step, energy_balance_closes) {
  Simulation sim = pile();
  for (std::size_t k = 0; k < sim.state.clumps.id.size(); ++k) sim.state.clumps.position[k].z() += 1e-3;
  sim.scale_step();
  sim.changed();
  const EnergyBalance before = energy_of(sim.model, sim.state);
  settle(sim, 1e-6);
  const EnergyBalance after = energy_of(sim.model, sim.state);
  EXPECT_GT(after.damping_loss, 0);
  EXPECT_LT(std::abs(after.total() - before.total()), 0.02 * after.damping_loss);
}

}  // namespace
}  // namespace trackbed
