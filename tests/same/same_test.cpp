// Same input, same bits: whatever the number of threads, the settings of the search, or what was thrown away.
#include <gtest/gtest.h>
#include <omp.h>

#include <cmath>
#include <functional>

#include "base/rng.h"
#include "scenes/scene.h"

namespace trackbed {
namespace {

using scenes::Setting;

/// Clumps of 12 pebbles, with inertia of a block, of two materials by turns, that fall into a box of planes.
Simulation falling_stones(int n) {
  Setting a;
  a.friction = 0.5;
  a.rolling_friction = 0.1;
  a.law = LawKind::linear_rolling;
  a.dashpot = {0.1, 0.1, DashpotMode::no_tension_slip_cut};
  a.damping = 0.2;
  a.gravity = {0, 0, -50};  // so that they are down soon
  Simulation sim = scenes::make_scene(a);
  sim.model.materials.push_back({"slag", 3e6, 2.5e6, 0.3, 0.2, a.density});
  sim.model.pairs = PairTable(sim.model.materials, a.law, a.dashpot);
  Rng rng(7, "same");
  std::vector<Pebble> pebbles;
  for (int k = 0; k < 12; ++k)
    pebbles.push_back({0.012 * (rng.rotation() * Vec3::UnitX()), rng.uniform(0.005, 0.009)});
  sim.model.templates.push_back(make_clump_template("lump", pebbles, 2.5e-5, {1e-9, 1.3e-9, 1.7e-9}));
  scenes::add_plane(sim, Vec3::Zero(), Vec3::UnitZ());
  for (const Vec3& side : {Vec3(1, 0, 0), Vec3(-1, 0, 0), Vec3(0, 1, 0), Vec3(0, -1, 0)})
    scenes::add_plane(sim, -0.11 * side, side);
  for (int k = 0; k < n; ++k) {
    const Vec3 x(-0.08 + 0.053 * (k % 4), -0.08 + 0.053 * (k / 4 % 4), 0.03 + 0.05 * (k / 16));
    const int c = add_clump(sim.model, sim.state, 1, rng.uniform(0.8, 1.1), k % 2, {x, rng.rotation()});
    set_motion(sim.state, c, {0, 0, -3}, Vec3::Zero());
  }
  return sim;
}

constexpr int steps = 6000;

std::uint64_t run(Simulation sim, const std::function<void(Simulation&, int)>& meddle = {},
                  int last = steps) {
  for (int k = 0; k < last; ++k) {
    if (meddle) meddle(sim, k);
    sim.step();
  }
  EXPECT_GT(sim.work.touching, 100);
  return hash(sim.state);
}

std::uint64_t reference() {
  static const std::uint64_t value = run(falling_stones(208));
  return value;
}

TEST(same, any_number_of_threads) {
  const int before = omp_get_max_threads();
  for (int threads : {1, 2, 4}) {
    omp_set_num_threads(threads);
    EXPECT_EQ(run(falling_stones(208)), reference()) << threads;
  }
  omp_set_num_threads(before);
}

// Fewer stones make smaller patches, and blocks of pairs from before then lie across two of them.
TEST(same, stones_removed_on_any_number_of_threads) {
  const auto remove_some = [](Simulation& sim, int k) {
    if (k != 9000) return;
    std::vector<int> gone;
    for (int c = 0; c < sim.state.clumps.size(); c += 7) gone.push_back(c);
    const int patch = sim.work.patch_size;
    remove_clumps(sim.state, gone);
    sim.changed();
    sim.step();
    EXPECT_LT(sim.work.patch_size, patch);
  };
  constexpr int long_run = 12000;  // so many stones are longer on their way down
  const int before = omp_get_max_threads();
  omp_set_num_threads(1);
  const std::uint64_t alone = run(falling_stones(560), remove_some, long_run);
  for (int threads : {2, 4}) {
    omp_set_num_threads(threads);
    EXPECT_EQ(run(falling_stones(560), remove_some, long_run), alone) << threads;
  }
  omp_set_num_threads(before);
}

TEST(same, any_skin_and_margin) {
  for (const auto& [skin, margin] : {std::pair{1.5e-4, 1e-3}, {3e-4, 6e-3}, {9e-4, 3e-3}}) {
    Simulation sim = falling_stones(208);
    sim.model.search = {skin, margin};
    EXPECT_EQ(run(std::move(sim)), reference()) << skin << " " << margin;
  }
}

TEST(same, workspace_thrown_away_at_any_step) {
  EXPECT_EQ(run(falling_stones(208),
                [](Simulation& sim, int k) {
                  if (k % 777 == 101) sim.work = {};
                }),
            reference());
}

TEST(same, stones_in_another_order_move_alike) {
  Simulation a = falling_stones(64), b = falling_stones(64);
  Clumps& c = b.state.clumps;
  for (auto* values : {&c.position, &c.velocity, &c.angular_momentum, &c.angular_velocity, &c.inertia})
    std::reverse(values->begin(), values->end());
  std::reverse(c.orientation.begin(), c.orientation.end());
  std::reverse(c.material.begin(), c.material.end());
  std::reverse(c.scale.begin(), c.scale.end());
  std::reverse(c.mass.begin(), c.mass.end());
  std::reverse(c.inertial_mass.begin(), c.inertial_mass.end());
  int most = 0;  // contacts at a time
  for (int k = 0; k < 1300; ++k) {
    a.step();
    b.step();
    most = std::max(most, a.work.touching);
  }
  EXPECT_GT(most, 10);
  for (std::size_t k = 0; k < 64; ++k)  // to rounding, which collisions have not yet made grow
    EXPECT_LT((a.state.clumps.position[k] - c.position[63 - k]).norm(), 1e-10) << k;
}

}  // namespace
}  // namespace trackbed
