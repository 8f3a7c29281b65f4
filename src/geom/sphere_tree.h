// A tree of bounding spheres over spheres or triangles, built once, walked in any pose.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <utility>
#include <vector>

#include "base/vec.h"

namespace trackbed {

struct Sphere {
  Vec3 centre;
  double radius;
};

/// Levels of spheres: the items themselves, in an order in which neighbours follow each other, then a bound
/// of each eight consecutive spheres of the level below, up to the one bound of all. The spheres of a level
/// stand in columns, so that eight are compared at once.
class SphereTree {
 public:
  static constexpr int width = 8;

  struct Level {
    int count = 0;
    std::vector<double> x, y, z,
        radius;  // width more than there are: any eight may be read from any sphere on

    Sphere operator[](int k) const {
      const std::size_t n = static_cast<std::size_t>(k);
      return {{x[n], y[n], z[n]}, radius[n]};
    }
  };

  SphereTree() = default;
  /// Items are halved along the longest side of the box of their centres; ties are broken by index.
  explicit SphereTree(const std::vector<Sphere>& items);

  /// Item k of the tree is item order()[k] of the input.
  const std::vector<int>& order() const { return order_; }
  const std::vector<Level>& levels() const { return levels_; }
  int top() const { return static_cast<int>(levels_.size()) - 1; }
  /// Of all items.
  Sphere bound() const { return levels_.back()[0]; }

  /// The spheres [first, last) one level further down that a sphere bounds.
  std::pair<int, int> below(int level, int sphere) const {
    const int first = width * sphere, count = levels_[static_cast<std::size_t>(level - 1)].count;
    return {first, std::min(first + width, count)};
  }

  /// Visits, ascending, the items below every bound that is_near(Sphere) finds near, until visit(item)
  /// returns true. Returns whether it did.
  template <class IsNear, class Visit>
  bool any(IsNear&& is_near, Visit&& visit) const {
    return !levels_.empty() && any_below(top(), 0, is_near, visit);
  }

  /// Visits the items whose spheres' surfaces are nearer to a point than limit(), negative inside, the
  /// nearest bounds first: what a visit finds may lower the limit.
  template <class Limit, class Visit>
  void approach(const Vec3& point, Limit&& limit, Visit&& visit) const {
    if (!levels_.empty()) approach_below(top(), 0, point, limit, visit);
  }

 private:
  template <class IsNear, class Visit>
  bool any_below(int level, int sphere, IsNear& is_near, Visit& visit) const {
    if (level == 0) return visit(sphere);
    if (!is_near(levels_[static_cast<std::size_t>(level)][sphere])) return false;
    const auto [first, last] = below(level, sphere);
    for (int k = first; k < last; ++k)
      if (any_below(level - 1, k, is_near, visit)) return true;
    return false;
  }

  template <class Limit, class Visit>
  void approach_below(int level, int sphere, const Vec3& point, Limit& limit, Visit& visit) const {
    if (level == 0) return visit(sphere);
    const auto [first, last] = below(level, sphere);
    std::array<std::pair<double, int>, width> nearest;  // distance, number
    std::size_t n = 0;
    for (int k = first; k < last; ++k) {
      const Sphere s = levels_[static_cast<std::size_t>(level - 1)][k];
      nearest[n++] = {(point - s.centre).norm() - s.radius, k};
    }
    std::sort(nearest.begin(), nearest.begin() + n);
    for (std::size_t k = 0; k < n && nearest[k].first < limit(); ++k)
      approach_below(level - 1, nearest[k].second, point, limit, visit);
  }

  std::vector<int> order_;
  std::vector<Level> levels_;
};

}  // namespace trackbed
