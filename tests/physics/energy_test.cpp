// The books of energy close, and a stored shear force goes with a pair that is carried round.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "base/rng.h"
#include "dem/laws/linear.h"
#include "scenes/scene.h"

namespace trackbed {
namespace {

/// Largest error of the balance over the potential energy released by 100 clumps that fall into a box.
double imbalance(double safety, double damping, bool has_dashpots) {
  scenes::Setting a;
  a.friction = 0.5;
  a.rolling_friction = 0.1;
  a.law = LawKind::linear_rolling;
  if (has_dashpots) a.dashpot = {0.05, 0.05, DashpotMode::no_tension_slip_cut};
  a.damping = damping;
  a.gravity = {0, 0, -9.81};
  Simulation sim = scenes::make_scene(a);
  sim.model.time_step.safety = safety;
  sim.model.templates.push_back(
      make_clump_template("tee", {{{-0.01, 0, 0}, 0.012}, {{0.01, 0, 0}, 0.012}, {{0, 0.012, 0}, 0.01}}, 3e-5,
                          {1.5e-9, 2.2e-9, 3e-9}));
  scenes::add_plane(sim, Vec3::Zero(), Vec3::UnitZ());
  for (const Vec3& side : {Vec3(1, 0, 0), Vec3(-1, 0, 0), Vec3(0, 1, 0), Vec3(0, -1, 0)})
    scenes::add_plane(sim, -0.13 * side, side);
  Rng rng(3, "energy");
  for (int k = 0; k < 100; ++k)
    add_clump(sim.model, sim.state, 1, 1, 0,
              {{-0.1 + 0.05 * (k % 5), -0.1 + 0.05 * (k / 5 % 5), 0.03 + 0.05 * (k / 25)}, rng.rotation()});
  sim.changed();
  const EnergyBalance start = energy_of(sim.model, sim.state);
  double worst = 0;
  scenes::run_until(sim, 0.3, [&] {
    if (sim.state.step % 50 == 0)
      worst = std::max(worst, std::abs(energy_of(sim.model, sim.state).total() - start.total()));
    return false;
  });
  return worst / (start.potential - energy_of(sim.model, sim.state).potential);
}

// V-25. A contact closes and opens somewhere within a step, yet its force acts for the whole of it: an impact
// loses (dt*)^2/6 of the energy it takes, dt* = dt sqrt(k/m), and the books can not know. This is the largest
// error left, and it is of second order: at safety 0.8, 0.4, 0.16 it is 5.8e-4, 1.7e-4, 2.9e-5 with damping
// 0.7, and 1.7e-3, 4.8e-4, 8.4e-5 with damping 0.3, where more energy ends in impacts. (Without the work of
// friction in those steps, 0.3 gave 5.6e-3, 1.5e-3, 2.4e-4.)
TEST(energy, balance_of_a_falling_bed_closes) {
  EXPECT_LT(imbalance(0.8, 0.7, false), 1e-3);
  EXPECT_LT(imbalance(0.16, 0.7, false), 1e-4);
  EXPECT_LT(imbalance(0.8, 0.3, false), 2.5e-3);
  EXPECT_LT(imbalance(0.16, 0.3, false), 1.5e-4);
}

// The dashpots' work is booked with the velocity before the kick: first order, 3.4e-3 and 6.2e-4.
TEST(energy, balance_with_dashpots_closes_to_first_order) {
  const double coarse = imbalance(0.8, 0.3, true), fine = imbalance(0.16, 0.3, true);
  EXPECT_LT(coarse, 5e-3);
  EXPECT_LT(fine, 1e-3);
}

// The dt*^2/6 of one impact: what a ball loses that comes down again and again at other times within the
// step.
TEST(energy, error_of_an_impact_is_that_of_its_first_and_last_step) {
  scenes::Setting a;
  a.damping = 0.5;
  const double step = 0.2;
  a.dt = step * scenes::contact_time_scale(a);
  double error = 0, given = 0;
  constexpr int times = 200;
  for (int k = 0; k < times; ++k) {
    Simulation sim = scenes::make_scene(a);
    scenes::add_plane(sim, Vec3::Zero(), Vec3::UnitZ());
    scenes::add_ball(sim, {0, 0, 0.02 + (k + 0.5) / times * a.dt}, {0, 0, -1});
    const double start = energy_of(sim.model, sim.state).total();
    scenes::run_until(sim, 8 * scenes::contact_time_scale(a));
    ASSERT_EQ(sim.work.touching, 0);
    error += energy_of(sim.model, sim.state).total() - start;
    given += start - energy_of(sim.model, sim.state).kinetic;
  }
  EXPECT_NEAR(error / given, -step * step / 6, 0.1 * step * step / 6);
}

TEST(energy, shear_force_goes_round_with_the_pair) {
  const Vec3 axis = Vec3(1, 2, -0.5).normalized();
  const ContactProperties p{LawKind::linear, 1e6, 1e6, 10, 0, {}};
  for (const double total : {0.5 * std::numbers::pi, 2 * std::numbers::pi}) {
    const Vec3 n0 = Vec3(0.3, -0.4, 0.8).normalized();
    for (const Vec3& about : {axis, n0}) {  // any axis, and pure twist
      ContactMemory memory{n0, 1e-5, n0.unitOrthogonal(), Vec3::Zero()};
      const Vec3 shear = memory.shear;
      Losses losses;
      constexpr int steps = 1000;
      for (int k = 1; k <= steps; ++k) {
        const Vec3 normal = Eigen::AngleAxisd(total * k / steps, about) * n0;
        const double dt = 1e-3, twist = total / steps / dt * about.dot(normal);
        Linear::respond({1e-5, normal, Vec3::Zero(), Vec3::Zero(), twist, 0.02, 0.1, dt}, p, memory, losses);
      }
      EXPECT_NEAR(memory.shear.norm(), 1, 1e-10);
      // Tilt and twist one after the other in each step: third order in its angle.
      EXPECT_LT((memory.shear - Eigen::AngleAxisd(total, about) * shear).norm(), total < 2 ? 1e-6 : 3e-5);
    }
  }
}

}  // namespace
}  // namespace trackbed
