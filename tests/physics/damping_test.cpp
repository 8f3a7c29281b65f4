// Cundall's local damping against its closed forms: a swing loses less towards rest than it takes away from
// it.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "scenes/scene.h"

namespace trackbed {
namespace {

using scenes::Setting;

struct Swing {
  double ratio;        // of two amplitudes in sequence
  double half_period;  // over sqrt(m/k)
};

/// A ball on a plane that swings about its rest overlap, never leaving the plane; from the lowest point
/// upwards.
Swing swing(double alpha, double step) {
  Setting a;
  a.gravity = {0, 0, -9.81};
  a.damping = alpha;
  a.dt = step * scenes::contact_time_scale(a);
  Simulation sim = scenes::make_scene(a);
  sim.model.time_step.safety = 2;
  scenes::add_plane(sim, Vec3::Zero(), Vec3::UnitZ());
  const double weight = scenes::contact_time_scale(a) * scenes::contact_time_scale(a) * a.kn * 9.81;
  const double rest = a.radius - weight / a.kn, amplitude = 0.9 * weight / a.kn;
  // On its way up by a hair: at no velocity there would be no damping in the first half kick.
  const int ball = scenes::add_ball(sim, {0, 0, rest - amplitude}, {0, 0, 1e-15});
  const Vec3& velocity = sim.state.clumps.velocity[static_cast<std::size_t>(ball)];
  double last = 0, top = 0;
  int steps = 0;
  do {
    last = velocity.z();
    sim.step();
    ++steps;
    top = std::max(top, sim.state.clumps.position[0].z() - rest);
  } while (velocity.z() > 0);
  // Velocities belong to the middle of steps; the kick in which they turn has one force, damped as on the way
  // up.
  const double turns_at = (steps - 1.5 + last / (last - velocity.z())) * a.dt;
  return {top / amplitude, turns_at / scenes::contact_time_scale(a)};
}

// V-14, asked 5e-3 and 2e-4.
TEST(damping, swing_towards_rest_and_away) {
  for (const double alpha : {0.1, 0.3, 0.5, 0.7}) {
    const double ratio = std::sqrt((1 - alpha) / (1 + alpha));
    const double half_period = 0.5 * std::numbers::pi * (1 / std::sqrt(1 - alpha) + 1 / std::sqrt(1 + alpha));
    for (const auto& [step, tolerance] : {std::pair{0.1, 5e-3}, std::pair{0.02, 2e-4}}) {
      const Swing s = swing(alpha, step);
      EXPECT_NEAR(s.ratio / ratio, 1, tolerance) << alpha << " " << step;
      EXPECT_NEAR(s.half_period / half_period, 1, tolerance) << alpha << " " << step;
    }
  }
}

TEST(damping, slows_the_fall_and_the_rise) {
  Setting a;
  a.gravity = {0, 0, -9.81};
  a.damping = 0.7;
  a.dt = 1e-4;
  Simulation sim = scenes::make_scene(a);
  scenes::add_ball(sim, Vec3::Zero());
  scenes::add_ball(sim, {1, 0, 0}, {0, 0, 2});
  scenes::run_until(sim, 0.1);
  const double time = sim.state.time - 0.5 * sim.state.dt;  // that the velocities belong to
  // The first half kick of a ball at rest is undamped, as there is no motion to damp.
  EXPECT_NEAR(sim.state.clumps.velocity[0].z(), -(0.3 * time + 0.7 * 0.5e-4) * 9.81, 1e-12);
  EXPECT_NEAR(sim.state.clumps.velocity[1].z(), 2 - 1.7 * 9.81 * time, 1e-12);
}

TEST(damping, leaves_rest_alone) {
  Setting a;
  a.gravity = {0, 0, -9.81};
  a.damping = 0.7;
  Simulation sim = scenes::make_scene(a);
  scenes::add_plane(sim, Vec3::Zero(), Vec3::UnitZ());
  scenes::add_ball(sim, {0, 0, 0.02});
  scenes::run_until(sim, 0.05);
  EXPECT_NEAR((0.02 - sim.state.clumps.position[0].z()) / 8.71151e-7, 1, 1e-6);
  EXPECT_NEAR((0.02 - sim.state.clumps.position[0].z()) / (sim.state.clumps.mass[0] * 9.81 / 1e6), 1, 1e-9);
}

/// Mean force that two planes need to carry a ball up with `drift` while they shake it with `shake`, over
/// that of (27) at full share: alpha m w shake.
double drag(double alpha, double drift, double shake) {
  Setting a;
  a.damping = alpha;
  a.dashpot.normal = 0.5;  // the ball does not ring where its damping turns
  a.dt = 0.1 * scenes::contact_time_scale(a);
  Simulation sim = scenes::make_scene(a);
  const double held = 1e-4;  // overlap with either plane, that it never leaves
  const int below = scenes::add_plane(sim, Vec3::Zero(), Vec3::UnitZ());
  const int above = scenes::add_plane(sim, {0, 0, 2 * (a.radius - held)}, -Vec3::UnitZ());
  scenes::add_ball(sim, {0, 0, a.radius - held}, {0, 0, drift + shake});
  const double w = 0.005 / scenes::contact_time_scale(a);  // so slow that the ball goes with the planes
  const int steps = static_cast<int>(std::lround(2 * std::numbers::pi / (w * a.dt)));
  double force = 0;
  for (int cycle = 0; cycle < 3; ++cycle)
    for (int k = 0; k < steps; ++k) {
      for (const int plane : {below, above})
        sim.state.walls[static_cast<std::size_t>(plane)].velocity.z() =
            drift + shake * std::cos(2 * std::numbers::pi * k / steps);
      sim.step();
      if (cycle > 0)  // the planes' force on the ball is the opposite of what it does to them
        for (const int plane : {below, above})
          force -= sim.state.walls[static_cast<std::size_t>(plane)].force.z() / (2 * steps);
    }
  return force / (alpha * sim.state.clumps.mass[0] * w * shake);
}

// A stone that trembles faster than it drifts is dragged as by a dashpot to the ground (27b).
TEST(damping, drags_what_trembles_as_a_dashpot_to_the_ground) {
  for (const double alpha : {0.1, 0.4, 0.7}) {
    const double whole = 2 / std::numbers::pi / (1 - alpha * alpha);
    for (const double ratio : {0.1, 0.5, 1.0, 2.0})
      EXPECT_NEAR(drag(alpha, ratio * 1e-3, 1e-3) / (std::min(ratio, 1.0) * whole), 1, 0.01)
          << alpha << " " << ratio;
  }
}

}  // namespace
}  // namespace trackbed
