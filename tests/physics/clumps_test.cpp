// Free rotation, and the stable step of one ball.
#include <gtest/gtest.h>

#include <cmath>

#include "dem/rotation.h"
#include "dem/timestep.h"
#include "scenes/scene.h"

namespace trackbed {
namespace {

struct Top {
  double flip, energy_error, momentum_error;
};

/// Torque-free top with moments 1, 2, 3: time of the first sign change of w2 that ends a half period.
Top spin(const Vec3& w0, double dt) {
  const Vec3 inertia(1, 2, 3);
  Quat q = Quat::Identity();
  const Vec3 momentum = w0.cwiseProduct(inertia);
  const double energy = 0.5 * w0.dot(momentum);
  Top top{0, 0, 0};
  double last = w0.y(), first = -1, time = 0;
  while (time < 200) {
    rotate_freely(q, momentum, inertia, dt);
    time += dt;
    const Vec3 w = (q.conjugate() * momentum).cwiseQuotient(inertia);
    if (last * w.y() < 0) {
      const double crossing = time - dt * w.y() / (w.y() - last);
      if (first >= 0 && top.flip == 0) top.flip = crossing - first;
      if (first < 0) first = crossing;
    }
    last = w.y();
    top.energy_error =
        std::max(top.energy_error, std::abs(0.5 * w.dot(inertia.cwiseProduct(w)) / energy - 1));
    top.momentum_error =
        std::max(top.momentum_error, std::abs(inertia.cwiseProduct(w).norm() / momentum.norm() - 1));
  }
  return top;
}

TEST(clumps, free_top_turns_over_in_time) {
  const struct {
    Vec3 w0;
    double half_period, tolerance;
  } cases[] = {{{1, 1, 1}, 3.211352, 2e-5}, {{0.01, 1, 0.01}, 19.552867, 5e-5}};
  for (const auto& c : cases)
    for (double dt : {0.02, 0.01}) {
      const Top top = spin(c.w0, dt);
      EXPECT_NEAR(top.flip / c.half_period, 1, c.tolerance) << dt << " " << c.w0.transpose();
      EXPECT_LT(top.energy_error, dt > 0.015 ? 1e-5 : 2.5e-6) << dt;
      EXPECT_LT(top.momentum_error, 1e-12);
    }
}

TEST(clumps, stable_step_of_one_ball_on_a_plane_and_in_a_lattice) {
  const double unit = scenes::contact_time_scale({});
  Simulation plane = scenes::make_scene({});
  scenes::add_plane(plane, Vec3::Zero(), Vec3::UnitZ());
  scenes::add_ball(plane, {0, 0, std::nextafter(0.02, 0)});  // in touch by the last bit
  plane.changed();
  EXPECT_NEAR(stable_step(plane.model, plane.state, plane.work).dt / (0.8 * std::sqrt(0.4) * unit), 1, 1e-12);

  for (const auto& [law, factor] :
       {std::pair{LawKind::linear, 0.8 * std::sqrt(0.1)}, {LawKind::linear_rolling, 0.8 * std::sqrt(0.08)}}) {
    scenes::Setting a;
    a.law = law;
    a.rolling_friction = 0.1;
    Simulation lattice = scenes::make_scene(a);
    scenes::add_ball(lattice, Vec3::Zero());
    for (int axis = 0; axis < 3; ++axis)
      for (double side : {-1.0, 1.0})
        scenes::add_ball(lattice, side * std::nextafter(0.04, 0) * Vec3::Unit(axis));
    lattice.changed();
    EXPECT_NEAR(stable_step(lattice.model, lattice.state, lattice.work).dt / (factor * unit), 1, 1e-12);
  }
}

}  // namespace
}  // namespace trackbed
