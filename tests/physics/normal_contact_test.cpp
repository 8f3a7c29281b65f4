// Head-on impacts and rest against their closed forms (Chung & Ooi 2011, linear versions).
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <utility>
#include <vector>

#include "scenes/scene.h"

namespace trackbed {
namespace {

using scenes::Setting;

constexpr double pi = std::numbers::pi;

TEST(normal_contact, two_balls_exchange_their_speeds) {
  // Leapfrog is second order: 1.2e-3 of overlap at dt* = 0.1 is the distance of the peak from the nearest
  // step.
  for (const auto& [step, tolerance] : {std::pair{0.1, 7e-4}, std::pair{0.02, 2e-5}}) {
    Setting a;
    a.dt = step * scenes::contact_time_scale(a);
    Simulation sim = scenes::make_scene(a);
    scenes::add_ball(sim, {-0.0205, 0, 0}, {0.5, 0, 0});
    scenes::add_ball(sim, {0.0205, 0, 0}, {-0.5, 0, 0});
    double largest = 0, touched = 0;
    scenes::run_until(sim, 5e-3, [&] {
      largest =
          std::max(largest, 0.04 - (sim.state.clumps.position[1] - sim.state.clumps.position[0]).norm());
      if (sim.work.touching > 0) touched += a.dt;
      return false;
    });
    const double mass = sim.state.clumps.mass[0];
    EXPECT_NEAR(mass, 0.0888023523, 1e-9);
    EXPECT_NEAR(sim.state.clumps.velocity[0].x() / -0.5, 1.0, tolerance);
    EXPECT_NEAR(sim.state.clumps.velocity[1].x() / 0.5, 1.0, tolerance);
    EXPECT_NEAR(largest / 2.107159e-4, 1.0, 0.25 * step * step);
    EXPECT_NEAR(touched, 6.619834e-4, a.dt);
    EXPECT_NEAR((sim.state.clumps.velocity[0] + sim.state.clumps.velocity[1]).norm(), 0.0, 1e-12);
  }
}

/// A fan of six coplanar facets about the origin.
TriangleMesh fan_of_six() {
  TriangleMesh mesh;
  mesh.vertices.push_back(Vec3::Zero());
  for (int k = 0; k < 6; ++k)
    mesh.vertices.emplace_back(0.1 * std::cos(k * pi / 3), 0.1 * std::sin(k * pi / 3), 0);
  for (int k = 1; k <= 6; ++k) mesh.facets.push_back({0, k, k % 6 + 1});
  return mesh;
}

// V-2.
TEST(normal_contact, ball_meets_a_plane_a_facet_an_edge_and_a_vertex_alike) {
  const double step = 0.01;
  Setting a;
  a.dt = step * scenes::contact_time_scale(a);
  struct Impact {
    double overlap = 0, touched = 0, force = 0, speed = 0;
  };
  const auto impact = [&](const auto& add_support) {
    Simulation sim = scenes::make_scene(a);
    add_support(sim);
    scenes::add_ball(sim, {0, 0, 0.0201}, {0, 0, -1});
    Impact seen;
    scenes::run_until(sim, 2e-3, [&] {
      seen.overlap = std::max(seen.overlap, 0.02 - sim.state.clumps.position[0].z());
      seen.force = std::max(seen.force, sim.state.clumps.force[0].z());
      if (sim.work.touching > 0) seen.touched += a.dt;
      return false;
    });
    seen.speed = sim.state.clumps.velocity[0].z();
    return seen;
  };
  const Impact plane = impact([](Simulation& sim) { scenes::add_plane(sim, Vec3::Zero(), Vec3::UnitZ()); });
  EXPECT_NEAR(plane.touched, 9.361859e-4, a.dt);
  // The peak lies within half a step of a step: 1 - cos(step/2) of it at most.
  EXPECT_NEAR(plane.overlap / 2.979972e-4, 1.0, 0.25 * step * step);
  EXPECT_NEAR(plane.force / 297.997, 1.0, 0.25 * step * step);
  EXPECT_NEAR(plane.speed, 1.0, 1e-4);

  const TriangleMesh facet{{{-0.1, -0.1, 0}, {0.2, -0.1, 0}, {-0.1, 0.2, 0}}, {{0, 1, 2}}};
  const TriangleMesh edge{{{-0.1, 0, 0}, {0, -0.1, 0}, {0.1, 0, 0}, {0, 0.1, 0}}, {{0, 1, 2}, {0, 2, 3}}};
  for (const TriangleMesh& mesh : {facet, edge, fan_of_six()}) {
    const Impact met = impact([&](Simulation& sim) { scenes::add_plate(sim, mesh); });
    EXPECT_NEAR(met.overlap / plane.overlap, 1.0, 1e-9) << mesh.facets.size();
    EXPECT_NEAR(met.force / plane.force, 1.0, 1e-9) << mesh.facets.size();
    EXPECT_NEAR(met.speed, plane.speed, 1e-9) << mesh.facets.size();
    EXPECT_DOUBLE_EQ(met.touched, plane.touched) << mesh.facets.size();
  }
}

double rebound(double ratio, DashpotMode mode, double step) {
  Setting a;
  a.dashpot = {ratio, 0, mode};
  a.dt = step * scenes::contact_time_scale(a);
  Simulation sim = scenes::make_scene(a);
  sim.model.time_step.safety = 2;  // the step is small for the spring, and too careful for the dashpot
  scenes::add_plane(sim, Vec3::Zero(), Vec3::UnitZ());
  scenes::add_ball(sim, {0, 0, 0.02}, {0, 0, -1});
  scenes::run_until(sim, 4e-3);
  return sim.state.clumps.velocity[0].z();
}

TEST(normal_contact, dashpots_give_the_restitution_of_their_mode) {
  for (const double ratio : {0.05, 0.1, 0.2, 0.3, 0.5, 0.7, 0.9}) {
    const double root = ratio / std::sqrt(1 - ratio * ratio);
    const double may_pull = std::exp(-pi * root);
    const double no_pull = std::exp(-root * (pi - 2 * std::asin(ratio)));
    // The dashpot sees the velocity half a step old: first order in the step, up to 0.2 dt* (1e-3), by
    // where in a step the contact closes; measured 4.5e-4 without pull, 8.4e-4 with, halving with the step.
    const double tolerance = 1e-3;
    if (ratio < 0.8) {
      EXPECT_NEAR(rebound(ratio, DashpotMode::full, 0.005), may_pull, tolerance) << ratio;
      EXPECT_NEAR(rebound(ratio, DashpotMode::full_slip_cut, 0.005), may_pull, tolerance) << ratio;
    }
    EXPECT_NEAR(rebound(ratio, DashpotMode::no_tension, 0.005), no_pull, 0.5 * tolerance) << ratio;
    EXPECT_NEAR(rebound(ratio, DashpotMode::no_tension_slip_cut, 0.005), no_pull, 0.5 * tolerance) << ratio;
    EXPECT_NEAR(rebound(ratio, DashpotMode::no_tension, 0.1), no_pull, 1.5e-2) << ratio;
  }
}

TEST(normal_contact, bouncing_ball_comes_back_to_its_height) {
  std::vector<double> worst;
  for (const double step : {0.1, 0.02}) {
    Setting a;
    a.gravity = {0, 0, -9.81};
    a.dt = step * scenes::contact_time_scale(a);
    Simulation sim = scenes::make_scene(a);
    scenes::add_plane(sim, Vec3::Zero(), Vec3::UnitZ());
    scenes::add_ball(sim, {0, 0, 0.12});
    double first_touch = 0, top = 0, error = 0;
    int bounces = 0;
    bool touching = false;
    while (bounces < 20) {
      sim.step();
      const bool now = sim.work.touching > 0;
      if (now && first_touch == 0) first_touch = sim.state.time;
      if (now && !touching && first_touch < sim.state.time) {
        error = std::max(error, std::abs(top / 0.1 - 1));
        ++bounces;
      }
      if (now) top = 0;
      touching = now;
      top = std::max(top, sim.state.clumps.position[0].z() - 0.02);
    }
    EXPECT_NEAR(first_touch, 0.142784, a.dt);
    EXPECT_LT(error, 2e-2);  // 1e-3 a bounce, of either sign: where in the step the contact opens
    worst.push_back(error);
  }
  EXPECT_LT(worst[1], worst[0]);
}

TEST(normal_contact, column_of_three_rests_on_its_weight) {
  Setting a;
  a.gravity = {0, 0, -9.81};
  a.damping = 0.7;
  Simulation sim = scenes::make_scene(a);
  const int plane = scenes::add_plane(sim, Vec3::Zero(), Vec3::UnitZ());
  for (int k = 0; k < 3; ++k) scenes::add_ball(sim, {0, 0, 0.02 + 0.04 * k});
  scenes::run_until(sim, 0.15);
  const double weight = sim.state.clumps.mass[0] * 9.81;
  EXPECT_NEAR(weight, 0.871151, 1e-6);
  EXPECT_NEAR(-sim.state.walls[static_cast<std::size_t>(plane)].force.z(), 3 * weight, 3e-8);
  const auto& x = sim.state.clumps.position;
  EXPECT_NEAR(0.02 - x[0].z(), 3 * weight / 1e6, 1e-13);
  EXPECT_NEAR(0.04 - (x[1] - x[0]).z(), 2 * weight / 1e6, 1e-13);
  EXPECT_NEAR(0.04 - (x[2] - x[1]).z(), 1 * weight / 1e6, 1e-13);
  EXPECT_LT(unbalanced_ratio(sim.model, sim.state), 1e-8);
}

}  // namespace
}  // namespace trackbed
