// A binary tree of bounding spheres over spheres or triangles, built once, walked in any pose.
#pragma once

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
};

/// Builds the tree by halving the longest side of the box of centres; ties are broken by index.
SphereTree build_sphere_tree(const std::vector<Sphere>& items);

}  // namespace trackbed
