// The surface of a bed: on vertical lines about 20 mm apart, the highest point of any pebble, or the floor.
#pragma once

#include <array>
#include <optional>
#include <vector>

#include "lab/simulation.h"

namespace trackbed {

/// Vertical lines through the middles of the cells of a rectangle [m].
struct Lines {
  Eigen::AlignedBox2d where;
  int nx, ny;

  std::size_t size() const { return static_cast<std::size_t>(nx * ny); }
  std::size_t index(int i, int j) const { return static_cast<std::size_t>(j * nx + i); }
  Eigen::Vector2d line(int i, int j) const {
    return where.min() + where.sizes().cwiseProduct(Eigen::Vector2d((i + 0.5) / nx, (j + 0.5) / ny));
  }
  template <class Visit>
  void for_each(Visit&& visit) const {
    for (int j = 0; j < ny; ++j)
      for (int i = 0; i < nx; ++i) visit(i, j);
  }
};

/// Where the bed ends on each line: the surface near it, what stands out left aside.
class LocalHeights {
 public:
  LocalHeights(const Lines& lines, std::vector<double> heights)
      : lines_(lines), heights_(std::move(heights)) {}

  double at(const Eigen::Vector2d& place) const;  ///< above z = 0, on the nearest line [m]
  double mean() const;                            ///< [m]
  double highest() const;                         ///< [m]
  /// Over the lines in a rectangle, of the nearest line when there is none in it [m].
  double mean_over(const Eigen::AlignedBox2d& part) const;

 private:
  Lines lines_;
  std::vector<double> heights_;
};

/// What lines through square cells meet last, from below.
class Surface {
 public:
  static constexpr double cell = 0.02;  // [m]
  static constexpr int patch = 5;       // cells along a side of what counts as near

  /// Lines that meet no stone end at `floor` [m].
  Surface(const Eigen::AlignedBox2d& where, double floor);

  void add_ball(const Vec3& centre, double radius);
  /// The lines through a facet say nothing of the free surface.
  void cover(const std::array<Vec3, 3>& corners);
  /// Lines that are no part of the surface.
  template <class Ends>
  void leave_out(Ends&& is_left_out) {
    lines_.for_each([&](int i, int j) {
      if (is_left_out(lines_.line(i, j))) left_out_[lines_.index(i, j)] = true;
    });
  }

  /// Mean of the free lines, a tenth of the highest dropped; of those below bodies too when none is free [m].
  double mean() const;
  /// The same by squares of some 100 mm, so that slopes keep their shape; a square without a free line takes
  /// the mean of the nearest ones.
  LocalHeights local() const;

 private:
  /// Lines that tell of the surface.
  std::vector<bool> telling() const;
  template <class Visit>
  void for_lines(const Eigen::Array2d& low, const Eigen::Array2d& high, Visit&& visit) const;

  Lines lines_;
  std::vector<double> height_;  // above z = 0 [m]
  std::vector<bool> covered_, left_out_;
};

/// Of the bed in a rectangle [m].
Surface surface_of(const Simulation& sim, const Eigen::AlignedBox2d& where);

/// What a box or a wall hides when it is seen from above [m].
Eigen::AlignedBox2d footprint(const Eigen::AlignedBox3d& box);
Eigen::AlignedBox2d footprint(const WallShape& shape, const Pose& pose);

}  // namespace trackbed
