#include "dem/overlap.h"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <limits>

#include "base/rng.h"
#include "scenes/scene.h"

namespace trackbed {
namespace {

using Index = std::size_t;

/// Two stones of 1 to 30 pebbles near each other and near a box.
Simulation two_stones(std::uint64_t seed) {
  Rng rng(seed, "overlap");
  Simulation sim = scenes::make_scene({});
  for (int t = 0; t < 2; ++t) {
    std::vector<Pebble> pebbles;
    const std::uint32_t n = 1 + rng.index(30);
    for (std::uint32_t k = 0; k < n; ++k)
      pebbles.push_back({rng.uniform(0, 0.02) * (rng.rotation() * Vec3::UnitX()), rng.uniform(0.001, 0.008)});
    sim.model.templates.push_back(make_clump_template("lump", pebbles, 1e-5, {1e-9, 1e-9, 1e-9}));
    const Vec3 x = rng.uniform(0, 0.04) * (rng.rotation() * Vec3::UnitX());
    add_clump(sim.model, sim.state, t + 1, rng.uniform(0.5, 2), 0, {x, rng.rotation()});
  }
  const Vec3 away = rng.uniform(0, 0.06) * (rng.rotation() * Vec3::UnitX());
  scenes::add_plate(sim, box_mesh(Vec3::Constant(0.02)), {away, rng.rotation()});
  scenes::add_plane(sim, away, rng.rotation() * Vec3::UnitZ());
  return sim;
}

/// Pebbles of a stone in the world.
std::vector<Pebble> pebbles_of(const Simulation& sim, Index i) {
  const Clumps& c = sim.state.clumps;
  std::vector<Pebble> pebbles;
  for (const Pebble& p : sim.model.templates[static_cast<Index>(c.shape[i])].pebbles)
    pebbles.push_back({c.position[i] + c.orientation[i] * (c.scale[i] * p.centre), c.scale[i] * p.radius});
  return pebbles;
}

constexpr double far = std::numeric_limits<double>::infinity();

RC_GTEST_PROP(Overlap, StonesMeetWhereTwoPebblesDo, (std::uint64_t seed)) {
  const Simulation sim = two_stones(seed);
  double gap = far;
  for (const Pebble& p : pebbles_of(sim, 0))
    for (const Pebble& q : pebbles_of(sim, 1))
      gap = std::min(gap, (p.centre - q.centre).norm() - p.radius - q.radius);
  if (gap < 1e-9) {  // not asked how deep
    RC_ASSERT(stones_meet(sim.model, sim.state.clumps, 0, 1, 1e-9));
    return;
  }
  for (double more : {-1e-9, 1e-9})
    RC_ASSERT(stones_meet(sim.model, sim.state.clumps, 0, 1, gap + more) == (more > 0));
}

RC_GTEST_PROP(Overlap, AStoneMeetsAWallWhereAPebbleDoes, (std::uint64_t seed)) {
  const Simulation sim = two_stones(seed);
  for (Index w = 0; w < 2; ++w) {
    const WallShape& shape = sim.model.walls[w].shape;
    double gap = far;
    for (const Pebble& p : pebbles_of(sim, 0)) {
      const Vec3 x = sim.state.walls[w].pose.to_body(p.centre);
      if (shape.is_plane) gap = std::min(gap, x.z() - p.radius);
      for (const Facet& f : shape.facets) gap = std::min(gap, (closest_point(f, x) - x).norm() - p.radius);
    }
    if (gap < 1e-9) {  // not asked how deep
      RC_ASSERT(stone_meets_wall(sim.model, sim.state, 0, static_cast<int>(w), 1e-9));
      continue;
    }
    for (double more : {-1e-9, 1e-9})
      RC_ASSERT(stone_meets_wall(sim.model, sim.state, 0, static_cast<int>(w), gap + more) == (more > 0));
  }
}

TEST(Overlap, InsideOfABox) {
  const WallShape box = make_mesh_wall("box", box_mesh(Vec3(1, 2, 3)));
  EXPECT_TRUE(is_inside(box, {0.5, 1, 1.5}));
  EXPECT_TRUE(is_inside(box, {1e-6, 1e-6, 1e-6}));
  EXPECT_FALSE(is_inside(box, {-1e-6, 1e-6, 1e-6}));
  EXPECT_FALSE(is_inside(box, {0.5, 1, 4}));
}

}  // namespace
}  // namespace trackbed
