// A binary tree of bounding spheres over spheres or triangles, built once, walked in any pose.
#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include "base/vec.h"

namespace trackbed {

struct Sphere {
  Vec3 centre;
  double radius;
};

/// Nodes in depth-first order: the left child of node k is k + 1, the right child is `right`. Leaves hold up
/// to leaf_size items that lie side by side in the order given by `order` (item k of the tree is item
/// order[k] of the input).
struct SphereTree {
  static constexpr int leaf_size = 4;
  struct Node {
    Sphere bound;
    int first, count;  // items of the whole subtree
    int right;         // index of the right child; 0 for a leaf
    bool is_leaf() const { return right == 0; }
  };
  std::vector<Node> nodes;
  std::vector<int> order;

  /// Visits, ascending, the items below every node whose bound is_near(Sphere) finds near, until visit(item)
  /// returns true. Returns whether it did.
  template <class IsNear, class Visit>
  bool any(IsNear&& is_near, Visit&& visit) const {
    std::array<int, 64> stack;  // a tree that halves its items is never that deep
    std::size_t top = 0;
    if (!nodes.empty()) stack[top++] = 0;
    while (top > 0) {
      const int k = stack[--top];
      const Node& node = nodes[static_cast<std::size_t>(k)];
      if (!is_near(node.bound)) continue;
      if (!node.is_leaf()) {
        stack[top++] = node.right;
        stack[top++] = k + 1;
        continue;
      }
      for (int item = node.first; item < node.first + node.count; ++item)
        if (visit(item)) return true;
    }
    return false;
  }
};

/// Builds the tree by halving the longest side of the box of centres; ties are broken by index.
SphereTree build_sphere_tree(const std::vector<Sphere>& items);

}  // namespace trackbed
