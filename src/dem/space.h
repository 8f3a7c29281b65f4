// The space in which stones live: all three dimensions, or the plane y = 0 with a thickness. In the plane
// stones are discs of that thickness; forces are those of the thickness, per metre where it is 1 m. One
// engine does both: what lies in the plane is held there (motion.cpp), and volumes grow with another power of
// size.
#pragma once

#include <cmath>
#include <numbers>

#include "base/rng.h"
#include "base/vec.h"

namespace trackbed {

struct Space {
  double thickness = 0;  // of the plane [m]; 0: all three dimensions

  bool is_plane() const { return thickness > 0; }
  int dimensions() const { return is_plane() ? 2 : 3; }

  /// Volume [m^3] of the ball, or the disc, of this diameter [m].
  double volume_of_size(double diameter) const {
    constexpr double pi = std::numbers::pi;
    return is_plane() ? pi / 4 * diameter * diameter * thickness : pi / 6 * diameter * diameter * diameter;
  }
  /// Its diameter [m].
  double size_of_volume(double volume) const {
    constexpr double pi = std::numbers::pi;
    return is_plane() ? std::sqrt(4 * volume / (pi * thickness)) : std::cbrt(6 * volume / pi);
  }
  /// How volumes grow when all lengths that the space has grow by `scale`.
  double growth_of_volume(double scale) const { return is_plane() ? scale * scale : scale * scale * scale; }

  /// The point of the space nearest to a point.
  Vec3 nearest(const Vec3& point) const { return is_plane() ? Vec3(point.x(), 0, point.z()) : point; }

  /// Any orientation.
  Quat turn(Rng& rng) const {
    if (!is_plane()) return rng.rotation();
    const double half = rng.uniform(0, std::numbers::pi);
    return {std::cos(half), 0, std::sin(half), 0};
  }
};

}  // namespace trackbed
