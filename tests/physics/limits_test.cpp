// The step that the program chooses is right without thought, and nothing passes a wall unseen.
#include <gtest/gtest.h>

#include <cmath>

#include "base/error.h"
#include "dem/timestep.h"
#include "scenes/scene.h"

namespace trackbed {
namespace {

enum class End { rebounds, stops, passes };

/// Throws a stone of the given shape at a plate without thickness at the step its speed permits.
End thrown_at_a_plate(int shape, double speed, double kn) {
  scenes::Setting a;
  a.kn = a.ks = kn;
  a.friction = 0.3;
  Simulation sim = scenes::make_scene(a);
  // A ball with a spike of small pebbles that meets the plate first.
  sim.model.templates.push_back(
      make_clump_template("spike", {{{0, 0, 0.005}, 0.02}, {{0, 0, -0.016}, 0.003}, {{0, 0, -0.019}, 0.001}},
                          3.4e-5, {5e-9, 5.4e-9, 5.4e-9}));
  scenes::add_plate(sim, scenes::plate(-0.2, 0.2, -0.2, 0.2, 0, 7, 7));
  scenes::add_ball(sim, {0.003, 0.004, 0.021}, {0.1 * speed, 0, -speed}, Vec3::Zero(), 1, shape);
  try {
    sim.changed();
    for (int k = 0; k < 20000; ++k) {
      sim.step();
      const Vec3& x = sim.state.clumps.position[0];
      if (x.z() < 0 && sim.work.touching == 0) return End::passes;
      if (x.z() > 0.03 && sim.work.touching == 0) return End::rebounds;
    }
  } catch (const RunError&) {
    return End::stops;
  }
  return End::rebounds;
}

TEST(limits, a_fast_stone_does_not_pass_a_thin_plate) {
  for (int shape : {0, 1})
    for (double kn : {1e5, 1e6, 1e7})
      for (double speed : {1.0, 3.0, 10.0, 30.0, 60.0, 98.0}) {
        const End end = thrown_at_a_plate(shape, speed, kn);
        EXPECT_NE(end, End::passes) << shape << " " << kn << " " << speed;
      }
  EXPECT_EQ(thrown_at_a_plate(0, 3, 1e6), End::rebounds);
  EXPECT_EQ(thrown_at_a_plate(0, 98, 1e5), End::stops);
}

/// Big balls that fall on balls of a tenth of their size, one of which is a tenth smaller still.
Simulation bidisperse() {
  scenes::Setting a;
  a.friction = 0.4;
  a.gravity = {0, 0, -9.81};
  a.kn = a.ks = 1e5;
  Simulation sim = scenes::make_scene(a);
  scenes::add_plane(sim, Vec3::Zero(), Vec3::UnitZ());
  for (const Vec3& side : {Vec3(1, 0, 0), Vec3(-1, 0, 0), Vec3(0, 1, 0), Vec3(0, -1, 0)})
    scenes::add_plane(sim, -0.03 * side, side);
  for (int k = 0; k < 100; ++k)
    scenes::add_ball(sim, {-0.027 + 0.006 * (k % 10), -0.027 + 0.006 * (k / 10), 0.0022}, {0, 0, -0.1},
                     Vec3::Zero(), k == 37 ? 0.05 : 0.1);
  scenes::add_ball(sim, {0.001, 0.002, 0.026}, {0, 0, -0.2});
  return sim;
}

TEST(limits, step_of_a_bidisperse_bed_is_that_of_its_smallest_ball) {
  Simulation sim = bidisperse();
  sim.changed();
  const StableStep stable = stable_step(sim.model, sim.state, sim.work);
  EXPECT_EQ(stable.clump, 37);
  EXPECT_NEAR(stable.dt / (0.8 * std::sqrt(0.4 * sim.state.clumps.mass[37] / 1e5)), 1, 1e-12);

  const double start = energy_of(sim.model, sim.state).total();
  double worst = 0, most = 0;
  scenes::run_until(sim, 0.02, [&] {
    if (sim.state.step % 100) return false;
    const EnergyBalance e = energy_of(sim.model, sim.state);
    worst = std::max(worst, std::abs(e.total() - start));
    most = std::max(most, e.kinetic + e.strain);
    return false;
  });
  EXPECT_LT(worst, 0.01 * start);
  EXPECT_LT(most, start);

  Simulation chosen = bidisperse();
  chosen.model.time_step.fixed = 0.999 * stable.dt;
  EXPECT_NO_THROW(chosen.changed());
  chosen.model.time_step.fixed = 1.001 * stable.dt;
  try {
    chosen.changed();
    ADD_FAILURE() << "a step above the stable one was taken";
  } catch (const RunError& error) {
    EXPECT_NE(std::string(error.what()).find("stone 37"), std::string::npos) << error.what();
  }
}

// A stone made smaller within a run shortens the step at the next look.
TEST(limits, step_follows_a_stone_that_shrinks) {
  Simulation sim = bidisperse();
  sim.changed();
  const double before = sim.state.planned_dt;
  rescale(sim.model, sim.state, 37, 0.5);
  sim.changed();
  EXPECT_NEAR(sim.state.planned_dt / before, std::pow(0.5, 1.5), 1e-12);
}

}  // namespace
}  // namespace trackbed
