#include "dem/numbering.h"

#include <gtest/gtest.h>

#include <map>

#include "base/rng.h"
#include "dem/touching.h"
#include "scenes/scene.h"

namespace trackbed {
namespace {

using Index = std::size_t;

/// Dumb-bells and balls dropped into a box, sliding against each other.
Simulation heap() {
  scenes::Setting a;
  a.law = LawKind::linear_rolling;
  a.friction = a.rolling_friction = 0.4;
  a.damping = 0.3;
  a.gravity = {0, 0, -9.81};
  Simulation sim = scenes::make_scene(a);
  sim.model.templates.push_back(make_clump_template(
      "dumb-bell", {{{-0.01, 0, 0}, 0.02}, {{0.01, 0, 0}, 0.015}}, 5e-5, {8e-9, 1.4e-8, 1.4e-8}));
  scenes::add_plane(sim, Vec3::Zero(), Vec3::UnitZ());
  scenes::add_plane(sim, {-0.1, 0, 0}, Vec3::UnitX());
  scenes::add_plane(sim, {0.035, 0, 0}, -Vec3::UnitX());
  scenes::add_plane(sim, {0, -0.035, 0}, Vec3::UnitY());
  scenes::add_plane(sim, {0, 0.1, 0}, -Vec3::UnitY());
  Rng rng(1, "heap");
  for (int k = 0; k < 40; ++k) {
    const Vec3 x(-0.065 + 0.065 * (k % 2), 0.065 * (k / 2 % 2), 0.035 + 0.065 * (k / 4 * 3 % 10));
    add_clump(sim.model, sim.state, k % 2, 1, 0, {x, rng.rotation()});
  }
  sim.changed();
  for (int k = 0; k < 20000; ++k) sim.step();
  return sim;
}

/// What each contact does to each of its stones, by the ids of the stones and the pebbles.
using Key = std::array<int, 4>;
std::map<Key, Vec3> forces_by_id(const Simulation& sim) {
  std::map<Key, Vec3> forces;
  const std::vector<int>& id = sim.state.clumps.id;
  for (const PairBlock& block : sim.state.pair_blocks)
    for (const ClumpPair& p : block.pairs)
      for (Index k = static_cast<Index>(p.first); k < static_cast<Index>(p.first + p.count); ++k) {
        const ContactMemory& m = block.memory[k];
        if (!m.touches()) continue;
        const int i = id[static_cast<Index>(p.i)], j = id[static_cast<Index>(p.j)];
        const auto [a, b] = block.keys[k];
        const Vec3 force = m.overlap * m.normal + m.shear + m.rolling;
        forces[{i, j, a, b}] = -force;
        forces[{j, i, b, a}] = force;
      }
  for (const WallBlock& block : sim.state.wall_blocks)
    for (const WallPair& p : block.pairs)
      for (Index k = static_cast<Index>(p.first); k < static_cast<Index>(p.first + p.count); ++k)
        if (block.memory[k].points[0].touches())
          forces[{id[static_cast<Index>(p.clump)], -1 - p.wall, block.keys[k], 0}] =
              block.memory[k].points[0].shear;
  return forces;
}

std::map<int, Vec3> places_by_id(const Simulation& sim) {
  std::map<int, Vec3> places;
  for (Index k = 0; k < sim.state.clumps.id.size(); ++k)
    places[sim.state.clumps.id[k]] = sim.state.clumps.position[k];
  return places;
}

TEST(Numbering, StonesAndContactsStayWhatTheyAre) {
  Simulation sim = heap();
  const auto before = forces_by_id(sim);
  const auto places = places_by_id(sim);
  const std::vector<int> ids = sim.state.clumps.id;
  ASSERT_GT(before.size(), 40u);
  sim.number_by_place();
  EXPECT_NE(sim.state.clumps.id, ids);
  EXPECT_EQ(places_by_id(sim), places);
  const auto after = forces_by_id(sim);
  ASSERT_EQ(after.size(), before.size());
  double largest = 0;
  for (const auto& [key, force] : before) largest = std::max(largest, force.norm());
  for (const auto& [key, force] : before) {
    ASSERT_TRUE(after.contains(key));
    EXPECT_LT((after.at(key) - force).norm(), 1e-13 * largest);
  }
}

TEST(Numbering, ChangesNoMotionButByRounding) {
  Simulation one = heap(), other = one;
  other.number_by_place();
  one.changed();
  for (int k = 0; k < 200; ++k) {
    one.step();
    other.step();
  }
  EXPECT_NEAR(one.state.time, other.state.time, 1e-12);
  const auto places = places_by_id(one);
  for (const auto& [id, place] : places_by_id(other)) EXPECT_LT((place - places.at(id)).norm(), 1e-11);
}

TEST(Numbering, NeighboursComeNextToEachOther) {
  Simulation sim = scenes::make_scene({});
  Rng rng(2, "column");
  for (int k = 0; k < 1000; ++k)
    scenes::add_ball(sim, {rng.uniform(0, 0.2), rng.uniform(0, 0.2), rng.uniform(0, 2)});
  number_by_place(sim.state);
  // Cells of (0.08/1000)^(1/3) m: from layer to layer along the longest extent.
  const double cell = std::cbrt(0.08 / 1000);
  for (Index k = 1; k < 1000; ++k)
    EXPECT_GT(sim.state.clumps.position[k].z(), sim.state.clumps.position[k - 1].z() - 1.1 * cell);
}

}  // namespace
}  // namespace trackbed
