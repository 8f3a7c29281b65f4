// The wall that presses with a given force.
#include <gtest/gtest.h>

#include <cmath>

#include "base/rng.h"
#include "dem/servo.h"
#include "scenes/scene.h"

namespace trackbed {
namespace {

using scenes::Setting;

const Vec3 down(0, 0, -1);

/// One step with the lid driven by the servo; its force on the stones after it [N].
double press(Simulation& sim, int lid, double target) {
  WallState& wall = sim.state.walls[static_cast<std::size_t>(lid)];
  wall.velocity.z() = -servo_speed(sim.model, sim.state, lid, down, target);
  sim.step();
  return wall.force.z();
}

// V-18. The balls are held: nothing accelerates them.
TEST(servo, error_shrinks_to_a_fifth_each_step) {
  Setting a;
  a.dt = 2e-3;  // so that the limit on the wall's speed leaves the servo alone
  Simulation sim = scenes::make_scene(a);
  sim.model.time_step.safety = 100;
  for (int k = 0; k < 5; ++k) scenes::add_ball(sim, {0.05 * k, 0, 0.02});
  const int lid = scenes::add_plane(sim, {0, 0, 0.04 - 1e-4}, down);
  sim.changed();
  WallState& wall = sim.state.walls[static_cast<std::size_t>(lid)];
  const double target = 1500;
  double missing = target - wall.force.z();
  EXPECT_NEAR(missing, 1000, 1e-6);
  sim.state.clumps.inertial_mass.assign(5, 1e18);
  for (int k = 0; k < 5; ++k) {
    press(sim, lid, target);
    EXPECT_NEAR((target - wall.force.z()) / missing, 0.2, 1e-6) << k;
    missing = target - wall.force.z();
  }
  EXPECT_NEAR(missing, 0.32, 1e-6);
}

/// A settled bed of balls in a square box with a lid.
struct Bed {
  Simulation sim;
  int lid;
};

Bed make_bed(double kn) {
  Setting a;
  a.kn = a.ks = kn;
  a.friction = 0.3;
  a.damping = 0.7;
  a.gravity = {0, 0, -9.81};
  Bed bed{scenes::make_scene(a), 0};
  scenes::add_plane(bed.sim, Vec3::Zero(), Vec3::UnitZ());
  for (const Vec3& side : {Vec3(1, 0, 0), Vec3(-1, 0, 0), Vec3(0, 1, 0), Vec3(0, -1, 0)})
    scenes::add_plane(bed.sim, -0.0605 * side, side);
  Rng rng(5, "servo");
  for (int k = 0; k < 18; ++k) {
    const Vec3 place(-0.0402 + 0.0402 * (k % 3), -0.0402 + 0.0402 * (k / 3 % 3), 0.0201 + 0.0402 * (k / 9));
    scenes::add_ball(bed.sim, place + 1e-4 * (rng.rotation() * Vec3::UnitX()));
  }
  bed.lid = scenes::add_plane(bed.sim, {0, 0, 0.0806}, down);
  bed.sim.changed();
  return bed;
}

TEST(servo, free_bed_takes_the_force) {
  for (const double kn : {0.5e6, 0.5e7, 0.5e8, 0.5e9}) {  // pieces of 1e6 to 1e9 N/m
    Bed bed = make_bed(kn);
    double force = 0, most = 0;
    while (bed.sim.state.time < 0.2) most = std::max(most, force = press(bed.sim, bed.lid, 1000));
    EXPECT_LT(most, 1.05 * 1000) << kn;
    double worst = 0;
    for (int k = 0; k < 500; ++k) worst = std::max(worst, std::abs(press(bed.sim, bed.lid, 1000) / 1000 - 1));
    EXPECT_LT(worst, 1e-3) << kn << " " << force;
  }
}

}  // namespace
}  // namespace trackbed
