// Oblique impact of a ball on a plane and of two balls (Chung & Ooi 2011, linear versions; Di Maio & Di Renzo
// 2004).
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "scenes/scene.h"

namespace trackbed {
namespace {

using scenes::Setting;

struct Rebound {
  double velocity, rim;  // centre along x, and spin x radius (rolling along +x) [m/s]
};

/// Stiff, so that the lever arm R - U/2 is the radius to 5e-4, as in the limit the closed forms are of.
Rebound impact(double kappa, double friction, double along, double rim_speed) {
  Setting a;
  a.kn = 1e9;
  a.ks = kappa * a.kn;
  a.friction = friction;
  a.dt = 0.01 * scenes::contact_time_scale(a);
  Simulation sim = scenes::make_scene(a);
  scenes::add_plane(sim, Vec3::Zero(), Vec3::UnitZ());
  scenes::add_ball(sim, {0, 0, 0.02}, {along, 0, -1}, {0, rim_speed / 0.02, 0});
  scenes::run_until(sim, 4 * scenes::contact_time_scale(a));
  EXPECT_EQ(sim.work.touching, 0);
  return {sim.state.clumps.velocity[0].x(), 0.02 * sim.state.clumps.angular_velocity[0].y()};
}

struct Row {
  double along, stiff_velocity, stiff_rim, soft_velocity, soft_rim;
};
constexpr Row table[] = {
    {0.25, 0.2311, 0.0473, 0.10714, 0.35714},   {0.50, 0.3676, 0.3309, 0.21429, 0.71429},
    {1.00, 0.6122, 0.9696, 0.42857, 1.42857},   {2.00, 1.40000, 1.50000, 1.40000, 1.50000},
    {3.00, 2.40000, 1.50000, 2.40000, 1.50000}, {4.00, 3.40000, 1.50000, 3.40000, 1.50000}};

// delta/R = 5e-4 and the step of 1 % leave 3e-4; for the rim, 0.6 x delta/R on up to 1.5.
constexpr double tolerance = 4e-4;

TEST(oblique_impact, sticking_turning_and_sliding) {
  for (const Row& row : table) {
    const Rebound stiff = impact(1.0, 0.3, row.along, 0), soft = impact(2.0 / 7.0, 0.3, row.along, 0);
    EXPECT_NEAR(stiff.velocity, row.stiff_velocity, tolerance) << row.along;
    EXPECT_NEAR(stiff.rim, row.stiff_rim, tolerance) << row.along;
    EXPECT_NEAR(soft.velocity, row.soft_velocity, tolerance) << row.along;
    EXPECT_NEAR(soft.rim, row.soft_rim, tolerance) << row.along;
  }
}

TEST(oblique_impact, full_sticking) {
  for (const double kappa : {1.0, 0.5, 2.0 / 7.0}) {
    const double turned = std::cos(std::numbers::pi * std::sqrt(3.5 * kappa));
    EXPECT_NEAR(impact(kappa, 1e9, 1.0, 0).velocity, 5.0 / 7.0 + 2.0 / 7.0 * turned, 1e-3) << kappa;
  }
}

TEST(oblique_impact, spin_is_the_same_contact_problem) {
  for (const Row& row : table) {
    const double slip = row.along;  // s0 = -w0 R
    const Rebound r = impact(1.0, 0.3, 0, -slip);
    const double after = row.stiff_velocity - row.stiff_rim;
    EXPECT_NEAR(r.velocity, 2.0 / 7.0 * (after - slip), tolerance) << slip;
    EXPECT_NEAR(r.rim, -slip + 5.0 / 7.0 * (slip - after), 2 * tolerance) << slip;
  }
}

TEST(oblique_impact, two_unequal_balls_keep_their_momenta) {
  Setting a;
  a.friction = 0.4;
  a.dt = 0.05 * scenes::contact_time_scale(a) * std::pow(0.5, 1.5);
  Simulation sim = scenes::make_scene(a);
  scenes::add_ball(sim, {0.001, 0.002, 0}, {0.8, 0.3, -0.1}, {10, -30, 20});
  scenes::add_ball(sim, {0.0295, 0.01, 0.004}, {-0.7, 0.2, 0.1}, {-5, 40, 12}, 0.5);
  const auto momenta = [&] {
    const Clumps& c = sim.state.clumps;
    Eigen::Matrix<double, 6, 1> p = Eigen::Matrix<double, 6, 1>::Zero();
    for (std::size_t k = 0; k < 2; ++k) {
      p.head<3>() += c.mass[k] * c.velocity[k];
      p.tail<3>() += c.mass[k] * c.position[k].cross(c.velocity[k]) + c.angular_momentum[k];
    }
    return p;
  };
  const auto before = momenta();
  bool touched = false;
  scenes::run_until(sim, 5e-3, [&] { return touched |= sim.work.touching > 0, false; });
  EXPECT_TRUE(touched);
  EXPECT_EQ(sim.work.touching, 0);
  EXPECT_NEAR((momenta() - before).norm() / before.norm(), 0, 1e-10);
}

}  // namespace
}  // namespace trackbed
