#include "geom/sphere_tree.h"

#include <algorithm>
#include <numeric>

namespace trackbed {
namespace {

/// Sphere around the given items: centred in their box, as large as needed (a few per cent above the least).
Sphere bound_of(const std::vector<Sphere>& items, const int* first, const int* last) {
  Eigen::AlignedBox3d box;
  for (const int* k = first; k != last; ++k) {
    const Sphere& s = items[static_cast<std::size_t>(*k)];
    box.extend(s.centre - Vec3::Constant(s.radius));
    box.extend(s.centre + Vec3::Constant(s.radius));
  }
  Sphere bound{box.center(), 0};
  for (const int* k = first; k != last; ++k) {
    const Sphere& s = items[static_cast<std::size_t>(*k)];
    bound.radius = std::max(bound.radius, (s.centre - bound.centre).norm() + s.radius);
  }
  return bound;
}

void split(SphereTree& tree, const std::vector<Sphere>& items, int first, int count) {
  const std::size_t node = tree.nodes.size();
  int* begin = tree.order.data() + first;
  tree.nodes.push_back({bound_of(items, begin, begin + count), first, count, 0});
  if (count <= SphereTree::leaf_size) return;

  Eigen::AlignedBox3d centres;
  for (int k = 0; k < count; ++k) centres.extend(items[static_cast<std::size_t>(begin[k])].centre);
  Eigen::Index axis = 0;
  centres.sizes().maxCoeff(&axis);
  const int half = count / 2;
  std::nth_element(begin, begin + half, begin + count, [&](int a, int b) {
    const double ca = items[static_cast<std::size_t>(a)].centre[axis];
    const double cb = items[static_cast<std::size_t>(b)].centre[axis];
    return ca != cb ? ca < cb : a < b;
  });
  split(tree, items, first, half);
  tree.nodes[node].right = static_cast<int>(tree.nodes.size());
  split(tree, items, first + half, count - half);
}

}  // namespace

SphereTree build_sphere_tree(const std::vector<Sphere>& items) {
  SphereTree tree;
  tree.order.resize(items.size());
  std::iota(tree.order.begin(), tree.order.end(), 0);
  if (!items.empty()) split(tree, items, 0, static_cast<int>(items.size()));
  return tree;
}

}  // namespace trackbed
