#include "geom/sphere_tree.h"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <algorithm>

#include "base/rng.h"

namespace trackbed {
namespace {

using Index = std::size_t;

RC_GTEST_PROP(SphereTree, EveryNodeHoldsItsItems, (std::uint64_t seed)) {
  Rng rng(seed, "tree");
  std::vector<Sphere> items;
  const std::uint32_t n = 1 + rng.index(200);
  const bool on_a_grid = rng.index(2) == 1;  // many equal coordinates
  for (std::uint32_t k = 0; k < n; ++k) {
    Vec3 x(rng.uniform(-1, 1), rng.uniform(-1, 1), rng.uniform(-1, 1));
    if (on_a_grid) x = (2 * x).array().round();
    items.push_back({x, rng.uniform(0, 0.3)});
  }
  const SphereTree tree = build_sphere_tree(items);
  std::vector<int> order = tree.order;
  std::sort(order.begin(), order.end());
  for (Index k = 0; k < order.size(); ++k) RC_ASSERT(order[k] == static_cast<int>(k));
  RC_ASSERT(tree.nodes[0].first == 0 && tree.nodes[0].count == static_cast<int>(n));
  for (Index k = 0; k < tree.nodes.size(); ++k) {
    const SphereTree::Node& node = tree.nodes[k];
    for (int m = node.first; m < node.first + node.count; ++m) {
      const Sphere& item = items[static_cast<Index>(tree.order[static_cast<Index>(m)])];
      RC_ASSERT((item.centre - node.bound.centre).norm() + item.radius <= node.bound.radius + 1e-15);
    }
    if (node.is_leaf()) {
      RC_ASSERT(node.count <= SphereTree::leaf_size);
      continue;
    }
    const SphereTree::Node &left = tree.nodes[k + 1], &right = tree.nodes[static_cast<Index>(node.right)];
    RC_ASSERT(left.first == node.first && right.first == left.first + left.count);
    RC_ASSERT(left.count + right.count == node.count && left.count > 0 && right.count > 0);
  }
}

}  // namespace
}  // namespace trackbed
