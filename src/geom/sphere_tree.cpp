#include "geom/sphere_tree.h"

#include <numeric>

namespace trackbed {
namespace {

using Index = std::size_t;

/// Halves items down to single ones, so that an order leads to itself; all but the last of the parts that
/// become bounds are full.
void sort_by_place(const std::vector<Sphere>& items, int* begin, int count) {
  if (count < 2) return;
  int full = 1;
  while (full * SphereTree::width < count) full *= SphereTree::width;

  Eigen::AlignedBox3d centres;
  for (int k = 0; k < count; ++k) centres.extend(items[static_cast<Index>(begin[k])].centre);
  Eigen::Index axis = 0;
  centres.sizes().maxCoeff(&axis);
  const int half = std::max(1, (count / 2 + full / 2) / full) * full;
  std::nth_element(begin, begin + half, begin + count, [&](int a, int b) {
    const double ca = items[static_cast<Index>(a)].centre[axis];
    const double cb = items[static_cast<Index>(b)].centre[axis];
    return ca != cb ? ca < cb : a < b;
  });
  sort_by_place(items, begin, half);
  sort_by_place(items, begin + half, count - half);
}

SphereTree::Level level_of(const std::vector<Sphere>& spheres) {
  SphereTree::Level level;
  level.count = static_cast<int>(spheres.size());
  for (const Sphere& s : spheres) {
    level.x.push_back(s.centre.x());
    level.y.push_back(s.centre.y());
    level.z.push_back(s.centre.z());
    level.radius.push_back(s.radius);
  }
  for (auto* column : {&level.x, &level.y, &level.z, &level.radius})
    column->resize(spheres.size() + SphereTree::width, 0.0);
  return level;
}

/// Sphere around [first, last): centred in their box, as large as needed (a few per cent above the least).
Sphere bound_of(const Sphere* first, const Sphere* last) {
  Eigen::AlignedBox3d box;
  for (const Sphere* s = first; s != last; ++s) {
    box.extend(s->centre - Vec3::Constant(s->radius));
    box.extend(s->centre + Vec3::Constant(s->radius));
  }
  Sphere bound{box.center(), 0};
  for (const Sphere* s = first; s != last; ++s)
    bound.radius = std::max(bound.radius, (s->centre - bound.centre).norm() + s->radius);
  return bound;
}

}  // namespace

SphereTree::SphereTree(const std::vector<Sphere>& items) : order_(items.size()) {
  if (items.empty()) return;
  std::iota(order_.begin(), order_.end(), 0);
  sort_by_place(items, order_.data(), static_cast<int>(items.size()));
  std::vector<Sphere> spheres, bounds;
  // A bound is around the items themselves, not around the bounds below it.
  for (int k : order_) spheres.push_back(items[static_cast<Index>(k)]);
  levels_.push_back(level_of(spheres));
  for (Index each = width; levels_.back().count > 1; each *= width) {
    bounds.clear();
    for (Index first = 0; first < spheres.size(); first += each)
      bounds.push_back(
          bound_of(spheres.data() + first, spheres.data() + std::min(first + each, spheres.size())));
    levels_.push_back(level_of(bounds));
  }
}

}  // namespace trackbed
