// A ball that slides, spins or rolls on a plane under gravity.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "scenes/scene.h"

namespace trackbed {
namespace {

using scenes::Setting;

constexpr double g = 9.81, radius = 0.02;

/// A ball at rest overlap on a plane that leans by `angle`: gravity leans instead.
Simulation resting_ball(Setting a, double angle, const Vec3& velocity = Vec3::Zero(),
                        const Vec3& spin = Vec3::Zero()) {
  a.gravity = g * Vec3(std::sin(angle), 0, -std::cos(angle));
  a.dt = 0.1 * scenes::contact_time_scale(a);
  Simulation sim = scenes::make_scene(a);
  scenes::add_plane(sim, Vec3::Zero(), Vec3::UnitZ());
  scenes::add_ball(sim, {0, 0, radius}, velocity, spin);
  sim.state.clumps.position[0].z() -= sim.state.clumps.mass[0] * g * std::cos(angle) / a.kn;
  return sim;
}

/// Mean velocity along x over 0.05 s: the shear spring swings by 4.7e-4 m/s about it.
double mean_velocity(Simulation& sim) {
  const double from = sim.state.time, x = sim.state.clumps.position[0].x();
  scenes::run_until(sim, 0.05);
  return (sim.state.clumps.position[0].x() - x) / (sim.state.time - from);
}

TEST(sliding, ball_slides_until_it_rolls) {
  Setting a;
  a.friction = 0.3;
  Simulation sim = resting_ball(a, 0, {1, 0, 0});
  double rolls_at = 0;
  scenes::run_until(sim, 0.2, [&] {
    const Clumps& c = sim.state.clumps;
    if (rolls_at == 0 && c.velocity[0].x() <= radius * c.angular_velocity[0].y()) {
      rolls_at = sim.state.time;
      EXPECT_NEAR(c.position[0].x() / 0.083214, 1, 1e-3);
    }
    return false;
  });
  EXPECT_NEAR(rolls_at / 0.097083, 1, 1e-3);
  EXPECT_NEAR(mean_velocity(sim), 5.0 / 7.0, 2e-5);
  const double mass = sim.state.clumps.mass[0];
  EXPECT_NEAR(energy_of(sim.model, sim.state).friction_loss / (mass / 7), 1, 1e-4);
}

TEST(sliding, spinning_ball_rolls_away) {
  Setting a;
  a.friction = 0.3;
  Simulation sim = resting_ball(a, 0, Vec3::Zero(), {0, 50, 0});
  double rolls_at = 0;
  scenes::run_until(sim, 0.2, [&] {
    const Clumps& c = sim.state.clumps;
    if (rolls_at == 0 && c.velocity[0].x() >= radius * c.angular_velocity[0].y()) rolls_at = sim.state.time;
    return false;
  });
  EXPECT_NEAR(rolls_at / (2 * 50 * radius / (7 * 0.3 * g)), 1, 1e-3);
  EXPECT_NEAR(mean_velocity(sim), 0.285714, 3e-4);
}

TEST(sliding, ball_on_a_slope) {
  const struct {
    double degrees, friction, velocity, rim;
  } cases[] = {{20, 0.3, 1.198315, 1.198315}, {20, 0.05, 1.447177, 0.576160}, {10, 0.3, 0.608400, 0.608400}};
  for (const auto& c : cases) {
    Setting a;
    a.friction = c.friction;
    Simulation sim = resting_ball(a, c.degrees * std::numbers::pi / 180);
    scenes::run_until(sim, 0.5);
    const double late = sim.state.time - 0.5 * sim.state.dt;  // the time the velocity belongs to
    EXPECT_NEAR(sim.state.clumps.velocity[0].x() * 0.5 / late / c.velocity, 1, 4e-4) << c.degrees;
    EXPECT_NEAR(radius * sim.state.clumps.angular_velocity[0].y() * 0.5 / late / c.rim, 1, 4e-4) << c.degrees;
  }
}

TEST(sliding, ball_on_a_belt_takes_two_sevenths_of_its_speed) {
  Setting a;
  a.friction = 0.3;
  Simulation sim = resting_ball(a, 0);
  sim.state.walls[0].velocity = {0.1, 0, 0};
  scenes::run_until(sim, 0.1);
  EXPECT_NEAR(mean_velocity(sim), 0.1 * 2 / 7, 3e-5);
  // The rim under the ball goes with the belt; the swing of the shear spring is 4.7e-4 m/s.
  const Clumps& c = sim.state.clumps;
  EXPECT_NEAR(c.velocity[0].x() - radius * c.angular_velocity[0].y(), 0.1, 2e-3);
}

TEST(sliding, ball_on_a_turntable_feels_the_speed_under_it) {
  Setting a;
  a.friction = 0.3;
  Simulation sim = resting_ball(a, 0);
  sim.state.walls[0].pose.position = {-0.5, 0, 0};
  sim.state.walls[0].angular_velocity = {0, 0, 0.2};  // 0.1 m/s along y under the ball
  scenes::run_until(sim, 0.008);
  // Still sliding: friction speeds it up along the belt.
  EXPECT_NEAR(sim.state.clumps.velocity[0].y() / (0.3 * g * 0.008), 1, 1e-2);
}

TEST(sliding, plane_that_tilts_far_away_is_met_in_time) {
  // The plane turns about a point 3 m away and comes up under a ball that does not move.
  Setting a;
  Simulation sim = scenes::make_scene(a);
  sim.model.time_step.largest_travel = 1e6;
  const int plane = scenes::add_plane(sim, {-3, 0, 0}, Vec3::UnitZ());
  scenes::add_ball(sim, {0, 0, radius + 0.003});
  sim.state.walls[static_cast<std::size_t>(plane)].angular_velocity = {0, -0.01, 0};
  scenes::run_until(sim, 0.2, [&] { return sim.work.touching > 0; });
  EXPECT_NEAR(sim.state.time, 0.1, 2e-3);
}

}  // namespace
}  // namespace trackbed
