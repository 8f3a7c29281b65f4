// Two stones whose sphere trees are walked against each other.
#pragma once

#include <array>
#include <bit>
#include <tuple>

#include "base/lanes.h"
#include "dem/model.h"
#include "dem/pair_motion.h"
#include "dem/state.h"

namespace trackbed {

/// Two stones in the frame of the first.
class TwoStones {
 public:
  TwoStones(const Model& model, const Clumps& c, int i, int j, const Relative& pose)
      : i_(model.templates[static_cast<std::size_t>(c.shape[static_cast<std::size_t>(i)])]),
        j_(model.templates[static_cast<std::size_t>(c.shape[static_cast<std::size_t>(j)])]),
        scale_i_(c.scale[static_cast<std::size_t>(i)]),
        scale_j_(c.scale[static_cast<std::size_t>(j)]),
        offset_(row_of(pose.offset)) {
    const Mat3 turn = scale_j_ * pose.turn.toRotationMatrix();
    for (int k = 0; k < 3; ++k) axes_[static_cast<std::size_t>(k)] = row_of(turn.col(k));
  }

  /// Whether both have so few pebbles that there is nothing to choose from.
  bool are_simple() const {
    constexpr std::size_t few = 4;
    return i_.pebbles.size() <= few && j_.pebbles.size() <= few;
  }

  /// Whether there is no more than the skin [m] between pebble a of the first and b of the second.
  bool are_within(double skin, int a, int b) const {
    const Pebble &p = i_.pebbles[static_cast<std::size_t>(a)], &q = j_.pebbles[static_cast<std::size_t>(b)];
    const double reach = scale_i_ * p.radius + skin + scale_j_ * q.radius;
    const Row apart = Row(scale_i_) * row_of(p.centre) - place(q.centre.x(), q.centre.y(), q.centre.z());
    const Row square = apart * apart;
    return square[0] + square[1] + square[2] <= reach * reach;
  }

  /// Visits all pebbles (a, b) with no more than the skin [m] between them, until visit(a, b) returns true.
  /// Returns whether it did.
  template <class Visit>
  bool any_within(double skin, Visit&& visit) const;

 private:
  /// Spheres [first, last) of a level of a tree.
  struct Range {
    int level, first, last;
  };

  /// A point of the second stone, at scale 1.
  Row place(double x, double y, double z) const {
    return offset_ + axes_[0] * x + axes_[1] * y + axes_[2] * z;
  }

  static const SphereTree::Level& level_of(const ClumpTemplate& stone, const Range& range) {
    return stone.tree.levels()[static_cast<std::size_t>(range.level)];
  }

  template <class Visit>
  bool near(double skin, const Range& of_i, const Range& of_j, Visit&& visit) const;

  const ClumpTemplate &i_, &j_;
  double scale_i_, scale_j_;
  Row offset_;
  std::array<Row, 3> axes_;  // of the second, as long as its scale
};

/// Visits the spheres of two ranges, the first of them no wider than a bound, with no more than the skin
/// between them.
template <class Visit>
bool TwoStones::near(double skin, const Range& of_i, const Range& of_j, Visit&& visit) const {
  const SphereTree::Level &i = level_of(i_, of_i), &j = level_of(j_, of_j);
  const Lanes scale = scale_i_;
  for (int k = of_i.first; k < of_i.last; k += Lanes::size) {
    const std::size_t at = static_cast<std::size_t>(k);
    const Lanes x = scale * Lanes::load(&i.x[at]), y = scale * Lanes::load(&i.y[at]),
                z = scale * Lanes::load(&i.z[at]), reach_i = scale * Lanes::load(&i.radius[at]) + skin;
    const unsigned present = (1u << std::min(of_i.last - k, Lanes::size)) - 1u;
    for (int l = of_j.first; l < of_j.last; ++l) {
      const std::size_t b = static_cast<std::size_t>(l);
      const Row centre = place(j.x[b], j.y[b], j.z[b]);
      const Lanes dx = x - centre[0], dy = y - centre[1], dz = z - centre[2];
      const Lanes reach = reach_i + scale_j_ * j.radius[b];
      unsigned found = present & ~bits(dx * dx + dy * dy + dz * dz > reach * reach);
      for (; found != 0; found &= found - 1)
        if (visit(k + std::countr_zero(found), l)) return true;
    }
  }
  return false;
}

template <class Visit>
bool TwoStones::any_within(double skin, Visit&& visit) const {
  struct Bounds {
    int level_i, a, level_j, b;
  };
  constexpr std::size_t deepest = 11, most = SphereTree::width * SphereTree::width;
  std::array<Bounds, deepest * most> stack;  // a tree of more levels would have more items than an int counts
  std::size_t top = 0;
  stack[top++] = {i_.tree.top(), 0, j_.tree.top(), 0};
  while (top > 0) {
    const Bounds at = stack[--top];
    // The one on the higher level is opened, or both.
    Range of_i{at.level_i, at.a, at.a + 1}, of_j{at.level_j, at.b, at.b + 1};
    if (at.level_i > 0 && at.level_i >= at.level_j) {
      std::tie(of_i.first, of_i.last) = i_.tree.below(of_i.level, at.a);
      --of_i.level;
    }
    if (at.level_j > 0 && at.level_j >= at.level_i) {
      std::tie(of_j.first, of_j.last) = j_.tree.below(of_j.level, at.b);
      --of_j.level;
    }
    const bool are_pebbles = of_i.level == 0 && of_j.level == 0;
    const bool is_done = near(skin, of_i, of_j, [&](int a, int b) {
      if (are_pebbles) return visit(a, b);
      stack[top++] = {of_i.level, a, of_j.level, b};
      return false;
    });
    if (is_done) return true;
  }
  return false;
}

}  // namespace trackbed
