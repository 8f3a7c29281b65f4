// Rolling resistance (Ai et al. 2011, tests 1 and 2).
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <vector>

#include "scenes/scene.h"

namespace trackbed {
namespace {

using scenes::Setting;

constexpr double g = 9.81, radius = 0.02;

Simulation rolling_ball(double friction, double rolling, double slope, double speed) {
  Setting a;
  a.friction = friction;
  a.rolling_friction = rolling;
  a.law = LawKind::linear_rolling;
  const double angle = std::atan(slope);
  a.gravity = g * Vec3(std::sin(angle), 0, -std::cos(angle));
  a.dt = 0.1 * scenes::contact_time_scale(a);
  Simulation sim = scenes::make_scene(a);
  scenes::add_plane(sim, Vec3::Zero(), Vec3::UnitZ());
  scenes::add_ball(sim, {0, 0, radius}, {speed, 0, 0}, {0, speed / radius, 0});
  sim.state.clumps.position[0].z() -= sim.state.clumps.mass[0] * g * std::cos(angle) / a.kn;
  return sim;
}

TEST(rolling, resistance_stops_a_rolling_ball) {
  const double v = 0.5;  // half of the usual speed: a quarter of the way
  for (const double rolling : {0.1, 0.3}) {
    Simulation sim = rolling_ball(0.5, rolling, 0, v);
    const double stops_at = 7 * v / (5 * rolling * g), way = 7 * v * v / (10 * rolling * g);
    double stopped = 0;
    scenes::run_until(sim, 1.1 * stops_at, [&] {
      if (stopped == 0 && sim.state.clumps.velocity[0].x() <= 0) stopped = sim.state.time;
      return false;
    });
    // The springs swing back at the end, by milliseconds.
    EXPECT_NEAR(stopped / stops_at, 1, 2e-3);
    EXPECT_NEAR(sim.state.clumps.position[0].x() / way, 1, 3e-4);
    EXPECT_NEAR(energy_of(sim.model, sim.state).rolling_loss / (0.7 * sim.state.clumps.mass[0] * v * v), 1,
                5e-4);
  }
}

TEST(rolling, stopped_ball_swings_in_its_two_modes) {
  Simulation sim = rolling_ball(0.5, 10, 0, 1e-6);  // never slips
  // Project on the slow mode's period: both frequencies from zero crossings of the modal coordinates.
  const double unit = std::sqrt(1e6 / sim.state.clumps.mass[0]);
  const double slow = 0.671186 * unit, fast = 2.355740 * unit;
  // x'' = -(k/m)(x - R th), R th'' = (5/2)(k/m)(x - R th) - (5/2)(k/m) R th: shape of a mode is R th/x = 1 -
  // w^2.
  const double shape_slow = 1 - 0.671186 * 0.671186, shape_fast = 1 - 2.355740 * 2.355740;
  double angle = 0;
  std::vector<double> crossings[2];
  double last[2] = {0, 0};
  for (int k = 0; k < 2000; ++k) {
    sim.step();
    const Clumps& c = sim.state.clumps;
    angle += sim.state.dt * c.angular_velocity[0].y();
    const double x = c.position[0].x(), rim = radius * angle;
    const double modal[2] = {rim - shape_fast * x, rim - shape_slow * x};
    for (int m = 0; m < 2; ++m) {
      if (last[m] * modal[m] < 0)
        crossings[m].push_back(sim.state.time - sim.state.dt * modal[m] / (modal[m] - last[m]));
      last[m] = modal[m];
    }
  }
  const double expected[2] = {slow, fast};
  for (int m = 0; m < 2; ++m) {
    ASSERT_GT(crossings[m].size(), 10u);
    const double measured = std::numbers::pi * static_cast<double>(crossings[m].size() - 1) /
                            (crossings[m].back() - crossings[m].front());
    // (w dt)^2/24 of the leapfrog is 2.3e-3 for the fast mode.
    EXPECT_NEAR(measured / expected[m], 1, 3e-3) << m;
  }
}

TEST(rolling, slope_holds_up_to_the_coefficient) {
  Simulation stays = rolling_ball(2, 0.1, 0.09, 0);
  scenes::run_until(stays, 1);
  EXPECT_LT(std::abs(stays.state.clumps.position[0].x()), 1e-5);

  Simulation rolls = rolling_ball(2, 0.1, 0.11, 0);
  scenes::run_until(rolls, 1);
  EXPECT_NEAR(rolls.state.clumps.velocity[0].x(), 0.06965, 5e-4);  // the springs swing about the mean

  Simulation blocked = rolling_ball(2, 100, 1.0, 0);
  scenes::run_until(blocked, 0.5);
  EXPECT_LT(std::abs(blocked.state.clumps.position[0].x()), 1e-5);
}

TEST(rolling, ball_of_the_pfc_example_ends_at_five_sevenths) {
  Setting a;
  a.radius = 5e-3;
  a.density = 2500;
  a.kn = a.ks = std::numbers::pi * a.radius * 1e7;
  a.friction = 0.8;
  a.dashpot = {0.2, 0, DashpotMode::no_tension_slip_cut};
  a.law = LawKind::linear_rolling;
  a.gravity = {0, 0, -g};
  Simulation sim = scenes::make_scene(a);
  scenes::add_plane(sim, Vec3::Zero(), Vec3::UnitZ());
  scenes::add_ball(sim, {0, 0, a.radius}, {1, 0, 0});
  scenes::run_until(sim, 0.5);
  const double x = sim.state.clumps.position[0].x(), t = sim.state.time;
  scenes::run_until(sim, 0.1);
  EXPECT_NEAR((sim.state.clumps.position[0].x() - x) / (sim.state.time - t), 5.0 / 7.0, 2e-4);
}

// The loss of the last contact was booked again in every later step when it had held a rolling moment but no
// shear.
TEST(rolling, loss_of_an_opened_contact_is_booked_once) {
  Setting a;
  a.friction = 0;
  a.rolling_friction = 1;
  a.law = LawKind::linear_rolling;
  a.dt = 0.05 * scenes::contact_time_scale(a);
  Simulation sim = scenes::make_scene(a);
  scenes::add_ball(sim, {-0.0201, 0, 0}, {0.1, 0, 0}, {0, 3, 0});
  scenes::add_ball(sim, {0.0201, 0, 0}, {-0.1, 0, 0}, {0, -2, 0});
  bool touched = false;
  scenes::run_until(sim, 1, [&] {
    touched |= sim.work.touching > 0;
    return touched && sim.work.touching == 0;
  });
  const double loss = energy_of(sim.model, sim.state).rolling_loss;
  EXPECT_GT(loss, 0);
  scenes::run_until(sim, 0.01);
  EXPECT_EQ(energy_of(sim.model, sim.state).rolling_loss, loss);
}

}  // namespace
}  // namespace trackbed
