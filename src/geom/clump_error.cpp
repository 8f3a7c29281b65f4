#include "geom/clump_error.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <utility>

#include "geom/mass_properties.h"
#include "geom/surface_samples.h"

namespace trackbed {
namespace {

constexpr int surface_points = 10'000;

using Intervals = std::vector<std::pair<double, double>>;

double covered_length(Intervals& intervals) {
  std::sort(intervals.begin(), intervals.end());
  double length = 0, end = -std::numeric_limits<double>::infinity();
  for (const auto& [from, to] : intervals) {
    length += std::max(0.0, to - std::max(from, end));
    end = std::max(end, to);
  }
  return length;
}

/// Distance from p to the nearest of the spheres' surfaces; negative inside a sphere, then the deepest
/// counts.
double distance_to_union(const Vec3& p, const std::vector<Sphere>& spheres, const SphereTree& tree) {
  double best = std::numeric_limits<double>::infinity();
  tree.approach(
      p, [&] { return best; },
      [&](int k) {
        const Sphere& s = spheres[static_cast<std::size_t>(tree.order()[static_cast<std::size_t>(k)])];
        best = std::min(best, (p - s.centre).norm() - s.radius);
      });
  return best;
}

/// As many lines as a few million intervals allow: more than enough for 0.1 %.
int affordable_lines(const std::vector<Pebble>& pebbles) {
  Eigen::AlignedBox3d box;
  double shadow = 0;
  for (const Pebble& p : pebbles) {
    box.extend(p.centre);
    shadow += std::numbers::pi * p.radius * p.radius;
  }
  const double side = box.sizes().maxCoeff() + 2 * pebbles.front().radius;
  return static_cast<int>(std::clamp(side * std::sqrt(3e6 / shadow), 160.0, 400.0));
}

}  // namespace

double union_volume(const std::vector<Pebble>& pebbles, int lines) {
  Eigen::AlignedBox3d box;
  for (const Pebble& p : pebbles) {
    box.extend(p.centre - Vec3::Constant(p.radius));
    box.extend(p.centre + Vec3::Constant(p.radius));
  }
  const Vec3 gap = box.sizes() / lines;
  // Columns (or rows) of lines that pass through a sphere: those k with |low + (k + 0.5) gap - c| < r.
  const auto range = [&](const Pebble& p, Eigen::Index axis) {
    const double low = (p.centre[axis] - box.min()[axis]) / gap[axis] - 0.5, reach = p.radius / gap[axis];
    return std::pair{std::max(0, static_cast<int>(std::ceil(low - reach))),
                     std::min(lines - 1, static_cast<int>(std::floor(low + reach)))};
  };
  double length = 0;
  std::vector<Intervals> row(static_cast<std::size_t>(lines));
  for (int j = 0; j < lines; ++j) {
    for (Intervals& line : row) line.clear();
    for (const Pebble& p : pebbles) {
      const double dy = box.min().y() + (j + 0.5) * gap.y() - p.centre.y();
      if (std::abs(dy) >= p.radius) continue;
      const auto [first, last] = range(p, 0);
      for (int i = first; i <= last; ++i) {
        const double dx = box.min().x() + (i + 0.5) * gap.x() - p.centre.x();
        const double half2 = p.radius * p.radius - dx * dx - dy * dy;
        if (half2 <= 0) continue;
        const double half = std::sqrt(half2);
        row[static_cast<std::size_t>(i)].emplace_back(p.centre.z() - half, p.centre.z() + half);
      }
    }
    for (Intervals& line : row) length += covered_length(line);
  }
  return length * gap.x() * gap.y();
}

ClumpError clump_error(const TriangleMesh& solid, const std::vector<Pebble>& pebbles) {
  std::vector<Sphere> spheres;
  for (const Pebble& p : pebbles) spheres.push_back({p.centre, p.radius});
  const SphereTree tree(spheres);
  ClumpError error;
  error.volume_ratio = union_volume(pebbles, affordable_lines(pebbles)) / mass_properties(solid).volume;
  for (const SurfaceSample& sample : sample_surface(solid, surface_points)) {
    const double distance = std::abs(distance_to_union(sample.point, spheres, tree));
    error.mean_distance += distance / surface_points;
    error.max_distance = std::max(error.max_distance, distance);
  }
  return error;
}

}  // namespace trackbed
