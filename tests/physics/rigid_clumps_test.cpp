// Clumps as rigid bodies: one pebble is a ball, a block slides and tips as a whole.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "scenes/scene.h"

namespace trackbed {
namespace {

using scenes::Setting;

constexpr double g = 9.81;

/// A block of nx x ny x nz pebbles of 10 mm radius that touch, with the mass properties of a box of that
/// size.
ClumpTemplate block(int nx, int ny, int nz) {
  constexpr double d = 0.02;
  const Vec3 size = d * Vec3(nx, ny, nz);
  std::vector<Pebble> pebbles;
  for (int k = 0; k < nz; ++k)
    for (int j = 0; j < ny; ++j)
      for (int i = 0; i < nx; ++i)
        pebbles.push_back({d * Vec3(i - 0.5 * (nx - 1), j - 0.5 * (ny - 1), k - 0.5 * (nz - 1)), 0.5 * d});
  const double volume = size.prod();
  const Vec3 square = size.cwiseAbs2();
  return make_clump_template("block", pebbles, volume, volume / 12 * (Vec3::Constant(square.sum()) - square));
}

/// The block on a slope: gravity leans by `angle` towards +x; it stands at its rest overlap.
Simulation block_on_slope(const ClumpTemplate& shape, int feet, double friction, double angle) {
  Setting a;
  a.friction = friction;
  a.gravity = g * Vec3(std::sin(angle), 0, -std::cos(angle));
  Simulation sim = scenes::make_scene(a);
  sim.model.templates.push_back(shape);
  scenes::add_plane(sim, Vec3::Zero(), Vec3::UnitZ());
  scenes::add_ball(sim, Vec3::Zero(), Vec3::Zero(), Vec3::Zero(), 1, 1);
  double lowest = 0;
  for (const Pebble& p : shape.pebbles) lowest = std::min(lowest, p.centre.z() - p.radius);
  sim.state.clumps.position[0].z() = -lowest - sim.state.clumps.mass[0] * g * std::cos(angle) / (feet * a.kn);
  return sim;
}

double turned(const Simulation& sim) {
  return sim.state.clumps.orientation[0].angularDistance(Quat::Identity());
}

// V-16: the same ball, once with three equal moments and once as a clump of one pebble away from the origin's
// frame.
TEST(rigid_clumps, one_pebble_is_a_ball) {
  Setting a;
  a.friction = 0.3;
  a.gravity = {0, 0, -g};
  Simulation sim[2] = {scenes::make_scene(a), scenes::make_scene(a)};
  const ClumpTemplate& ball = sim[0].model.templates[0];
  sim[1].model.templates.push_back(
      make_clump_template("one", {{Vec3::Zero(), 0.02}}, ball.volume, ball.inertia));
  for (int k = 0; k < 2; ++k) {
    scenes::add_plane(sim[k], Vec3::Zero(), Vec3::UnitZ());
    scenes::add_ball(sim[k], {0, 0, 0.021}, {1, 0.3, -0.5}, {3, -5, 7}, 1, k);
    scenes::add_ball(sim[k], {0.05, 0.01, 0.022}, {-1, 0, 0}, {0, 4, 1}, 1, k);
    scenes::run_until(sim[k], 0.1);
  }
  for (std::size_t k = 0; k < 2; ++k) {
    EXPECT_LT((sim[0].state.clumps.position[k] - sim[1].state.clumps.position[k]).norm(), 1e-12);
    EXPECT_LT((sim[0].state.clumps.velocity[k] - sim[1].state.clumps.velocity[k]).norm(), 1e-12);
  }
  EXPECT_LT(sim[0].state.clumps.velocity[0].y(), 0.2);  // 0.3 at the start: they have met
}

TEST(rigid_clumps, two_pebbles_in_one_place_are_twice_as_stiff) {
  Setting a;
  a.damping = 0.7;
  a.gravity = {0, 0, -g};
  Simulation sim = scenes::make_scene(a);
  const ClumpTemplate& ball = sim.model.templates[0];
  sim.model.templates.push_back(
      make_clump_template("two", {{Vec3::Zero(), 0.02}, {Vec3::Zero(), 0.02}}, ball.volume, ball.inertia));
  scenes::add_plane(sim, Vec3::Zero(), Vec3::UnitZ());
  scenes::add_ball(sim, {0, 0, 0.02}, Vec3::Zero(), Vec3::Zero(), 1, 1);
  scenes::run_until(sim, 0.05);
  EXPECT_NEAR((0.02 - sim.state.clumps.position[0].z()) / (0.5 * sim.state.clumps.mass[0] * g / 1e6), 1,
              1e-8);
}

TEST(rigid_clumps, spinning_dumb_bell_falls_on_a_parabola) {
  Setting a;
  a.gravity = {0, 0, -g};
  a.dt = 1e-3;
  Simulation sim = scenes::make_scene(a);
  sim.model.time_step.safety = 100;
  sim.model.templates.push_back(block(2, 1, 1));
  scenes::add_ball(sim, Vec3::Zero(), {1, -2, 3}, {20, 5, -30}, 1, 1);
  for (int k = 0; k < 500; ++k) sim.step();
  const double t = sim.state.time;
  // Leapfrog is exact for a constant force.
  EXPECT_LT((sim.state.clumps.position[0] - Vec3(t, -2 * t, 3 * t - 0.5 * g * t * t)).norm(), 1e-12);
  EXPECT_GT(sim.state.clumps.angular_velocity[0].norm(), 20);
}

// V-17.
TEST(rigid_clumps, slab_rests_or_slides_on_a_slope) {
  const double friction = 0.4;
  // Still below the slope of friction; it takes up its shear at the start, and swings by twice m g sin/(9
  // k_s).
  Simulation rests = block_on_slope(block(3, 3, 1), 9, friction, std::atan(0.9 * friction));
  scenes::run_until(rests, 0.05);
  const double x = rests.state.clumps.position[0].x();
  scenes::run_until(rests, 0.5);
  const Vec3 weight = rests.state.clumps.mass[0] * rests.model.gravity;
  EXPECT_LT(std::abs(rests.state.clumps.position[0].x() - x), 2.5 * weight.x() / 9e6);
  EXPECT_LT(std::abs(rests.state.clumps.position[0].x() - x), 1e-6);

  const double angle = std::numbers::pi / 6;
  const double a = g * (std::sin(angle) - friction * std::cos(angle));
  EXPECT_NEAR(a, 1.506716, 1e-6);
  Simulation slides = block_on_slope(block(3, 3, 1), 9, friction, angle);
  // Friction builds up and the slab takes its place in the first milliseconds, in which it gains 5e-4 m/s.
  scenes::run_until(slides, 0.1);
  const double t = slides.state.time - 0.5 * slides.state.dt, v = slides.state.clumps.velocity[0].x();
  scenes::run_until(slides, 0.5);
  const double gained = slides.state.clumps.velocity[0].x() - v;
  EXPECT_NEAR(gained / (slides.state.time - 0.5 * slides.state.dt - t) / a, 1, 1e-3);
  EXPECT_LT(turned(slides), 1e-3);
}

TEST(rigid_clumps, tall_block_tips_beyond_its_foot) {
  // Pebbles touch the slope under their centres: the foot is 20 mm between its two rows, the centre of mass
  // 60 mm up.
  const double limit = 0.02 / (2 * 0.06);
  for (const double share : {0.95, 1.05}) {
    Simulation sim = block_on_slope(block(2, 2, 6), 4, 2.0, std::atan(share * limit));
    sim.model.local_damping = 0.3;  // lets the rocking of the start die out
    // Gravity leans over slowly enough for the rocking not to tip it: the first 5 % of the way is 0.4 s of
    // nothing.
    const Vec3 leaning = sim.model.gravity;
    for (int k = 1; k <= 100; ++k) {
      sim.model.gravity = (1 - 0.01 * k) * Vec3(0, 0, -g) + 0.01 * k * leaning;
      scenes::run_until(sim, 0.005);
    }
    scenes::run_until(sim, 1.0, [&] { return turned(sim) > 0.1; });
    if (share < 1)
      EXPECT_LT(turned(sim), 1e-3);
    else
      EXPECT_GT(turned(sim), 0.1);
  }
}

TEST(rigid_clumps, scaled_stone_has_scaled_mass_and_inertia) {
  Simulation sim = scenes::make_scene({});
  sim.model.templates.push_back(block(1, 2, 3));
  for (const double s : {1.0, 0.5, 1.7})
    scenes::add_ball(sim, Vec3::Zero(), Vec3::Zero(), Vec3::Zero(), s, 1);
  const Clumps& c = sim.state.clumps;
  EXPECT_NEAR(c.mass[0] / (2650 * 0.02 * 0.04 * 0.06), 1, 1e-12);
  EXPECT_NEAR(c.inertia[0].x() / (c.mass[0] / 12 * (0.04 * 0.04 + 0.06 * 0.06)), 1, 1e-12);
  EXPECT_NEAR(c.inertia[0].z() / (c.mass[0] / 12 * (0.02 * 0.02 + 0.04 * 0.04)), 1, 1e-12);
  for (std::size_t k = 1; k < 3; ++k) {
    EXPECT_NEAR(c.mass[k] / c.mass[0] / std::pow(c.scale[k], 3), 1, 1e-14);
    EXPECT_LT((c.inertia[k].cwiseQuotient(c.inertia[0]) / std::pow(c.scale[k], 5) - Vec3::Ones()).norm(),
              1e-14);
  }
}

}  // namespace
}  // namespace trackbed
