#include "geom/sphere_tree.h"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <algorithm>
#include <limits>

#include "base/rng.h"

namespace trackbed {
namespace {

using Index = std::size_t;

std::vector<Sphere> some_spheres(Rng& rng) {
  std::vector<Sphere> items;
  const std::uint32_t n = 1 + rng.index(700);
  const bool on_a_grid = rng.index(2) == 1;  // many equal coordinates
  for (std::uint32_t k = 0; k < n; ++k) {
    Vec3 x(rng.uniform(-1, 1), rng.uniform(-1, 1), rng.uniform(-1, 1));
    if (on_a_grid) x = (2 * x).array().round();
    items.push_back({x, rng.uniform(0, 0.3)});
  }
  return items;
}

RC_GTEST_PROP(SphereTree, EveryBoundHoldsItsItems, (std::uint64_t seed)) {
  Rng rng(seed, "tree");
  const std::vector<Sphere> items = some_spheres(rng);
  const SphereTree tree(items);
  std::vector<int> order = tree.order();
  std::sort(order.begin(), order.end());
  for (Index k = 0; k < order.size(); ++k) RC_ASSERT(order[k] == static_cast<int>(k));
  RC_ASSERT(tree.levels()[0].count == static_cast<int>(items.size()));
  RC_ASSERT(tree.levels().back().count == 1);
  int each = 1;
  for (int level = 0; level <= tree.top(); ++level, each *= SphereTree::width) {
    const SphereTree::Level& spheres = tree.levels()[static_cast<Index>(level)];
    for (int k = 0; k < spheres.count; ++k) {
      const int first = k * each, last = std::min(first + each, static_cast<int>(items.size()));
      RC_ASSERT(first < last);
      for (int m = first; m < last; ++m) {
        const Sphere& item = items[static_cast<Index>(tree.order()[static_cast<Index>(m)])];
        RC_ASSERT((item.centre - spheres[k].centre).norm() + item.radius <= spheres[k].radius + 1e-15);
      }
      if (level == 0) continue;
      const auto [below, end] = tree.below(level, k);
      RC_ASSERT(below == k * SphereTree::width && end > below && end - below <= SphereTree::width);
      RC_ASSERT(end ==
                std::min(below + SphereTree::width, tree.levels()[static_cast<Index>(level - 1)].count));
    }
  }
}

RC_GTEST_PROP(SphereTree, ApproachFindsTheNearestItem, (std::uint64_t seed)) {
  Rng rng(seed, "tree");
  const std::vector<Sphere> items = some_spheres(rng);
  const SphereTree tree(items);
  const Vec3 p(rng.uniform(-2, 2), rng.uniform(-2, 2), rng.uniform(-2, 2));
  const auto distance = [&](const Sphere& s) { return (p - s.centre).norm() - s.radius; };
  double nearest = std::numeric_limits<double>::infinity(), found = nearest;
  for (const Sphere& s : items) nearest = std::min(nearest, distance(s));
  Index visited = 0;
  tree.approach(
      p, [&] { return found; },
      [&](int k) {
        ++visited;
        found = std::min(found, distance(items[static_cast<Index>(tree.order()[static_cast<Index>(k)])]));
      });
  RC_ASSERT(found == nearest);
  RC_ASSERT(visited <= items.size());
}

RC_GTEST_PROP(SphereTree, ItsOrderLeadsToItself, (std::uint64_t seed)) {
  Rng rng(seed, "tree");
  const std::vector<Sphere> items = some_spheres(rng);
  const SphereTree tree(items);
  std::vector<Sphere> sorted;
  for (int k : tree.order()) sorted.push_back(items[static_cast<Index>(k)]);
  const SphereTree again(sorted);
  for (Index k = 0; k < sorted.size(); ++k) RC_ASSERT(again.order()[k] == static_cast<int>(k));
}

TEST(SphereTree, HalvesAreSpatial) {
  // 64 points in a row, given in a mixed order: each eight that share a bound are neighbours.
  std::vector<Sphere> items;
  for (int k = 0; k < 64; ++k) items.push_back({{static_cast<double>(k * 37 % 64), 0, 0}, 0.5});
  const SphereTree tree(items);
  ASSERT_EQ(tree.top(), 2);
  for (int k = 0; k < 8; ++k) {
    EXPECT_EQ(tree.levels()[1][k].centre.x(), 8 * k + 3.5);
    EXPECT_EQ(tree.levels()[1][k].radius, 4);
  }
}

}  // namespace
}  // namespace trackbed
