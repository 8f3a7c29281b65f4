#include "dem/search.h"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <array>
#include <set>

#include "base/rng.h"
#include "scenes/scene.h"

namespace trackbed {
namespace {

using Index = std::size_t;
using Key = std::array<int, 4>;  // stone, pebble, stone or -1 - wall, pebble

/// Stones of four shapes, whose trees have one to four levels, and many sizes, some far away, in each other's
/// way, between a plane and a box.
Simulation heap(std::uint64_t seed) {
  Rng rng(seed, "search");
  Simulation sim = scenes::make_scene({});
  sim.model.limits.overlap = 1e9;
  sim.model.limits.through = 1e9;
  sim.model.search = {rng.uniform(1e-4, 3e-3), 3e-3};
  for (int n : {1, 7, 40, 100}) {
    std::vector<Pebble> pebbles;
    for (int k = 0; k < n; ++k)
      pebbles.push_back({rng.uniform(0, 0.02) * (rng.rotation() * Vec3::UnitX()), rng.uniform(0.001, 0.008)});
    sim.model.templates.push_back(make_clump_template("lump", pebbles, 1e-5, {1e-9, 1e-9, 1e-9}));
  }
  for (int k = 0; k < 10; ++k) {
    const double away = k == 9 ? 30.0 : rng.uniform(0, 0.09);
    add_clump(sim.model, sim.state, 1 + k % 4, rng.uniform(0.3, 2), 0,
              {away * (rng.rotation() * Vec3::UnitX()), rng.rotation()});
  }
  scenes::add_plate(sim, box_mesh(Vec3::Constant(0.03)), {{0.02, 0, 0}, rng.rotation()});
  scenes::add_plane(sim, {0, 0, -0.05}, Vec3(0.2, -0.1, 1).normalized());
  return sim;
}

std::vector<Pebble> pebbles_of(const Simulation& sim, Index i) {
  const Clumps& c = sim.state.clumps;
  std::vector<Pebble> pebbles;
  for (const Pebble& p : sim.model.templates[static_cast<Index>(c.shape[i])].pebbles)
    pebbles.push_back({c.position[i] + c.orientation[i] * (c.scale[i] * p.centre), c.scale[i] * p.radius});
  return pebbles;
}

/// All pebbles with less than `reach` between them, or to a wall.
std::set<Key> near_ones(const Simulation& sim, double reach) {
  std::set<Key> keys;
  for (Index i = 0; i < sim.state.clumps.id.size(); ++i) {
    const std::vector<Pebble> mine = pebbles_of(sim, i);
    for (Index a = 0; a < mine.size(); ++a) {
      const Pebble& p = mine[a];
      for (Index j = i + 1; j < sim.state.clumps.id.size(); ++j) {
        const std::vector<Pebble> others = pebbles_of(sim, j);
        for (Index b = 0; b < others.size(); ++b)
          if ((p.centre - others[b].centre).norm() < p.radius + others[b].radius + reach)
            keys.insert({static_cast<int>(i), static_cast<int>(a), static_cast<int>(j), static_cast<int>(b)});
      }
      for (Index w = 0; w < sim.state.walls.size(); ++w) {
        const WallShape& shape = sim.model.walls[w].shape;
        const Vec3 x = sim.state.walls[w].pose.to_body(p.centre);
        double gap = shape.is_plane ? x.z() : 1e9;
        for (const Facet& f : shape.facets) gap = std::min(gap, (closest_point(f, x) - x).norm());
        if (gap < p.radius + reach)
          keys.insert({static_cast<int>(i), static_cast<int>(a), -1 - static_cast<int>(w), 0});
      }
    }
  }
  return keys;
}

std::set<Key> candidates(const Simulation& sim, bool only_touching) {
  std::set<Key> keys;
  for (const PairBlock& block : sim.state.pair_blocks)
    for (const ClumpPair& p : block.pairs)
      for (Index k = static_cast<Index>(p.first); k < static_cast<Index>(p.first + p.count); ++k)
        if (!only_touching || block.memory[k].touches())
          keys.insert({p.i, block.keys[k].a, p.j, block.keys[k].b});
  for (const WallBlock& block : sim.state.wall_blocks)
    for (const WallPair& p : block.pairs)
      for (Index k = static_cast<Index>(p.first); k < static_cast<Index>(p.first + p.count); ++k)
        if (!only_touching || block.memory[k].points[0].touches())
          keys.insert({p.clump, block.keys[k], -1 - p.wall, 0});
  return keys;
}

// Stones at rest list their candidates within a fiftieth of the skin, walls theirs within a fifth.
RC_GTEST_PROP(Search, CandidatesAreThePebblesWithinTheSkin, (std::uint64_t seed)) {
  Simulation sim = heap(seed);
  sim.changed();
  const double skin = sim.work.skin;
  const std::set<Key> found = candidates(sim, false), inner = near_ones(sim, 0.02 * skin - 1e-12),
                      outer = near_ones(sim, skin + 1e-12);
  RC_ASSERT(std::includes(found.begin(), found.end(), inner.begin(), inner.end()));
  RC_ASSERT(std::includes(outer.begin(), outer.end(), found.begin(), found.end()));
  RC_ASSERT(candidates(sim, true) == near_ones(sim, 0.0));
}

TEST(Search, FindsTheFirstStonesOfAnEmptyScene) {
  Simulation sim = scenes::make_scene({});
  sim.changed();
  scenes::add_ball(sim, Vec3::Zero());
  scenes::add_ball(sim, {0.0399, 0, 0});
  sim.changed();
  EXPECT_EQ(sim.work.touching, 1);
}

/// Every pebble in touch has a contact, and no other; adds their number to `met`.
void expect_all_contacts(const Simulation& sim, int& met) {
  const std::set<Key> touching = near_ones(sim, 0.0);
  met += static_cast<int>(touching.size());
  ASSERT_EQ(candidates(sim, true), touching);
}

// Whatever was refreshed and whatever was not: every pebble in touch has a contact, after each of many steps.
TEST(Search, NoContactIsMissedWhileStonesFlyAndTurn) {
  int met = 0;
  for (std::uint64_t seed = 1; seed <= 3; ++seed) {
    Simulation sim = heap(seed);
    sim.model.time_step.fixed = 2e-5;
    sim.model.time_step.largest_travel = 1e6;
    for (Material& m : sim.model.materials) m.kn = m.ks = 1e-3;  // they pass through each other
    sim.model.pairs = PairTable(sim.model.materials, LawKind::linear, {});
    Rng rng(seed, "motion");
    for (int c = 0; c < sim.state.clumps.size(); ++c)
      set_motion(sim.state, c, 3 * (rng.rotation() * Vec3::UnitX()), 200 * (rng.rotation() * Vec3::UnitX()));
    sim.state.walls[0].velocity = {1, 2, 0};
    sim.state.walls[0].angular_velocity = {30, 0, 50};
    for (int k = 0; k < 1000; ++k) {
      sim.step();
      if (k % 5) continue;
      ASSERT_NO_FATAL_FAILURE(expect_all_contacts(sim, met)) << seed << " " << k;
    }
  }
  EXPECT_GT(met, 1000);
}

// A ball that leaves a wall at once, farther than any skin: its contact ends, and is not there when it
// returns.
TEST(Search, ContactsWithWallsEndHoweverFarTheStoneHasGone) {
  Simulation sim = scenes::make_scene({});
  const double radius = sim.model.templates[0].bounding_radius;
  const int ball = scenes::add_ball(sim, {0, 0, 0.999 * radius});
  scenes::add_plane(sim, Vec3::Zero(), Vec3::UnitZ());
  sim.step();
  ASSERT_EQ(candidates(sim, true).size(), 1u);
  rescale(sim.model, sim.state, ball, 0.99);
  sim.changed();
  EXPECT_TRUE(candidates(sim, true).empty());
}

TEST(Search, MarginSuitsHowFarStonesGoInAStep) {
  Simulation sim = scenes::make_scene({});
  const double radius = scenes::Setting{}.radius;
  for (const double x : {0.0, 1.0}) scenes::add_ball(sim, {x, 0, 0}, {0, 5, 0});
  sim.step();
  EXPECT_NEAR(sim.work.margin, 0.15 * radius, 1e-15);
  for (int k = 0; k < 300; ++k) sim.step();
  EXPECT_NEAR(sim.work.margin, 0.6 * radius, 1e-15);
  for (int c = 0; c < 2; ++c) set_motion(sim.state, c, {0, 0.1, 0}, Vec3::Zero());
  for (int k = 0; k < 3000; ++k) sim.step();
  EXPECT_NEAR(sim.work.margin, 0.15 * radius, 1e-15);
}

// Balls, whose turning moves nothing, of many sizes, pressed into each other: they leap from rest.
TEST(Search, NoContactIsMissedWhileBallsLeapApart) {
  int met = 0;
  for (std::uint64_t seed = 1; seed <= 3; ++seed) {
    Rng rng(seed, "balls");
    scenes::Setting setting;
    setting.radius = 0.01;
    setting.kn = setting.ks = 1e3;
    setting.friction = 0.5;
    Simulation sim = scenes::make_scene(setting);
    sim.model.limits.overlap = 1e9;
    const auto within = [&](double most) { return rng.uniform(-most, most); };
    for (int k = 0; k < 300; ++k)
      scenes::add_ball(sim, {within(0.05), within(0.05), within(0.05)}, Vec3::Zero(),
                       {within(200), within(200), within(200)}, k % 10 == 0 ? 1.5 : rng.uniform(0.1, 0.4));
    scenes::add_plane(sim, {0, 0, -0.05}, Vec3::UnitZ());
    for (int k = 0; k < 100; ++k) {
      sim.step();
      if (k % 3) continue;
      ASSERT_NO_FATAL_FAILURE(expect_all_contacts(sim, met)) << seed << " " << k;
    }
  }
  EXPECT_GT(met, 10000);
}

}  // namespace
}  // namespace trackbed
