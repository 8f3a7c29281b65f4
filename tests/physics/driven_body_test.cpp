// Bodies that are held, driven along blocked axes, or free, against closed forms and the energy ledger.
#include <gtest/gtest.h>

#include <cmath>

#include "dem/inspect.h"
#include "scenes/scene.h"

namespace trackbed {
namespace {

using scenes::Setting;

/// A block of 0.2 x 0.1 x 0.1 m and 5 kg, free along z alone, its centre at the given place.
std::size_t add_block(Simulation& sim, const Vec3& at) {
  Wall block;
  block.shape = make_mesh_wall("block", box_mesh({0.2, 0.1, 0.1}, {-0.1, -0.05, -0.05}));
  block.body = BodyProperties{5.0, Vec3::Constant(0.01), {false, false, true}, {false, false, false}};
  return static_cast<std::size_t>(add_wall(sim, std::move(block), {at, Quat::Identity()}));
}

TEST(driven_body, falls_only_when_it_is_let_go) {
  Setting a;
  a.gravity = {0, 0, -9.81};
  a.dt = 1e-5;
  Simulation sim = scenes::make_scene(a);
  sim.model.time_step.safety = 2;
  const std::size_t block = add_block(sim, {0, 0, 1});
  scenes::add_ball(sim, {5, 5, 5});
  sim.state.walls[block].held = true;
  scenes::run_until(sim, 0.01);
  EXPECT_EQ(sim.state.walls[block].pose.position, Vec3(0, 0, 1));
  EXPECT_EQ(sim.state.walls[block].velocity, Vec3::Zero());

  sim.state.walls[block].held = false;
  const double before = sim.state.time;
  scenes::run_until(sim, 0.01);
  const double t = sim.state.time - before;
  EXPECT_NEAR(1 - sim.state.walls[block].pose.position.z(), 0.5 * 9.81 * t * t, 9.81 * t * a.dt);
}

// It keeps its velocity along x whatever the ball does to it, and falls along z as if it were not driven;
// what the drive puts in is found in the ball, the springs and the losses.
TEST(driven_body, pushes_a_ball_and_books_the_work) {
  Setting a;
  a.gravity = {0, 0, -9.81};
  a.friction = 0.4;
  a.dt = 0.02 * scenes::contact_time_scale(a);
  Simulation sim = scenes::make_scene(a);
  sim.model.time_step.safety = 2;
  scenes::add_plane(sim, Vec3::Zero(), Vec3::UnitZ());
  const std::size_t block = add_block(sim, {-0.1 - a.radius - 1e-5, 0, 0.3});
  sim.state.walls[block].held = true;
  sim.state.walls[block].pose.position.z() = a.radius + 0.02;
  const int ball = scenes::add_ball(sim, {0, 0, a.radius - 1e-6});
  sim.changed();
  const double energy = energy_of(sim.model, sim.state).total();
  sim.drive(block, {0.05, 0, 0});
  EXPECT_NEAR(energy_of(sim.model, sim.state).total(), energy, 1e-12);
  scenes::run_until(sim, 0.2);
  const Vec3 velocity = sim.state.walls[block].velocity;
  EXPECT_EQ(velocity, Vec3(0.05, 0, 0));
  const double gone = sim.state.clumps.position[static_cast<std::size_t>(ball)].x();
  EXPECT_NEAR(gone, 0.05 * sim.state.time, 0.5 * 0.05 * sim.state.time);
  EXPECT_GT(sim.state.walls[block].boundary_work, 0);
  EXPECT_NEAR(energy_of(sim.model, sim.state).total(), energy, 2e-3 * sim.state.walls[block].boundary_work);
}

// Without stones: a body that is driven along x falls freely along z, and nothing is lost.
TEST(driven_body, is_free_along_the_other_axes) {
  Setting a;
  a.gravity = {1.0, 0, -9.81};  // the drive works against the part along x
  a.dt = 1e-5;
  Simulation sim = scenes::make_scene(a);
  sim.model.time_step.safety = 2;
  const std::size_t block = add_block(sim, {0, 0, 1});
  scenes::add_ball(sim, {5, 5, 5});
  const double energy = energy_of(sim.model, sim.state).total();
  sim.drive(block, {0.3, 0, 7});  // z is free: that part is not taken
  scenes::run_until(sim, 0.02);
  const double t = sim.state.time;
  EXPECT_NEAR(sim.state.walls[block].pose.position.x(), 0.3 * t, 1e-12);
  EXPECT_NEAR(1 - sim.state.walls[block].pose.position.z(), 0.5 * 9.81 * t * t, 9.81 * t * a.dt);
  EXPECT_NEAR(sim.state.walls[block].boundary_work, 0.5 * 5 * 0.09 - 5 * 1.0 * 0.3 * t, 1e-9);
  EXPECT_NEAR(energy_of(sim.model, sim.state).total(), energy, 1e-4);
}

// Bearings about the third axis do no work and leave the momentum about the others alone. The body stands
// askew, so no axis of the world is principal. The turn of a step is of first order: energy to 1e-3 in 5,000
// steps.
TEST(driven_body, free_about_two_axes_keeps_its_energy_and_its_momentum_about_them) {
  Setting a;
  a.gravity = Vec3::Zero();
  a.dt = 1e-4;
  Simulation sim = scenes::make_scene(a);
  sim.model.time_step.safety = 2;
  const std::size_t block = add_block(sim, {0, 0, 1});
  scenes::add_ball(sim, {5, 5, 5});
  BodyProperties& body = *sim.model.walls[block].body;
  body.inertia = {0.01, 0.04, 0.02};
  body.free_shift = {false, false, false};
  body.free_turn = {true, true, false};
  WallState& wall = sim.state.walls[block];
  wall.pose.orientation = Quat(Eigen::AngleAxisd(0.3, Vec3(1, 2, 3).normalized()));
  const Mat3 r = wall.pose.orientation.toRotationMatrix();
  wall.angular_velocity = {1.0, 0.5, 0.0};
  wall.angular_momentum = r * body.inertia.asDiagonal() * r.transpose() * wall.angular_velocity;
  const Vec3 momentum = wall.angular_momentum;
  const double energy = 0.5 * momentum.dot(wall.angular_velocity);
  scenes::run_until(sim, 0.5);
  EXPECT_EQ(wall.angular_velocity.z(), 0);
  EXPECT_NEAR(wall.angular_momentum.x(), momentum.x(), 1e-12);
  EXPECT_NEAR(wall.angular_momentum.y(), momentum.y(), 1e-12);
  EXPECT_NEAR(0.5 * wall.angular_momentum.dot(wall.angular_velocity), energy, 1e-3 * energy);
}

// A bed is not at rest while a body falls onto it.
TEST(driven_body, that_falls_is_not_at_rest) {
  Setting a;
  a.gravity = {0, 0, -9.81};
  a.damping = 0.7;
  Simulation sim = scenes::make_scene(a);
  scenes::add_plane(sim, Vec3::Zero(), Vec3::UnitZ());
  const int ball = scenes::add_ball(sim, {5, 5, 0.02});
  const std::size_t block = add_block(sim, {0, 0, 1});
  scenes::run_until(sim, 0.05);
  const double ball_weight = 9.81 * sim.state.clumps.mass[static_cast<std::size_t>(ball)], weight = 9.81 * 5;
  EXPECT_NEAR(unbalanced_ratio(sim.model, sim.state), weight / (weight + 2 * ball_weight), 1e-3);
  sim.state.walls[block].held = true;
  EXPECT_LT(unbalanced_ratio(sim.model, sim.state), 1e-3);
}

}  // namespace
}  // namespace trackbed
