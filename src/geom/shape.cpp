#include "geom/shape.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <utility>

#include "geom/mass_properties.h"

namespace trackbed {
namespace {

constexpr double pi = std::numbers::pi;
using Vec2 = Eigen::Vector2d;

double cross(const Vec2& a, const Vec2& b) {
  return a.x() * b.y() - a.y() * b.x();
}

/// Corners of the convex hull of points in the plane, anticlockwise (Andrew's chain).
std::vector<Vec2> hull_of(std::vector<Vec2> points) {
  std::sort(points.begin(), points.end(),
            [](const Vec2& a, const Vec2& b) { return a.x() != b.x() ? a.x() < b.x() : a.y() < b.y(); });
  std::vector<Vec2> hull;
  for (int pass = 0; pass < 2; ++pass) {
    const std::size_t start = hull.size();
    for (const Vec2& p : points) {
      while (hull.size() >= start + 2 && cross(hull.back() - hull[hull.size() - 2], p - hull.back()) <= 0)
        hull.pop_back();
      hull.push_back(p);
    }
    hull.pop_back();
    std::reverse(points.begin(), points.end());
  }
  return hull;
}

/// The stone seen along a direction, in a frame of its own.
struct Shadow {
  Mat3 frame;  // columns: two axes in the plane, the direction
  double height = 0;
  std::vector<Vec2> outline;

  /// Sides of the rectangle around the outline whose first side is turned by the angle.
  Vec2 sides(double angle) const {
    const Vec2 u(std::cos(angle), std::sin(angle)), v(-u.y(), u.x());
    Vec2 low = Vec2::Constant(std::numeric_limits<double>::infinity()), high = -low;
    for (const Vec2& p : outline) {
      const Vec2 q(u.dot(p), v.dot(p));
      low = low.cwiseMin(q);
      high = high.cwiseMax(q);
    }
    return high - low;
  }
};

Shadow shadow_along(const Vec3& direction, const std::vector<Vec3>& points) {
  Shadow shadow;
  const Vec3 w = direction.normalized(), u = w.unitOrthogonal();
  shadow.frame << u, w.cross(u), w;
  std::vector<Vec2> flat;
  double low = std::numeric_limits<double>::infinity(), high = -low;
  for (const Vec3& p : points) {
    flat.emplace_back(shadow.frame.col(0).dot(p), shadow.frame.col(1).dot(p));
    low = std::min(low, w.dot(p));
    high = std::max(high, w.dot(p));
  }
  shadow.height = high - low;
  shadow.outline = hull_of(std::move(flat));
  return shadow;
}

struct Best {
  double value = std::numeric_limits<double>::infinity();
  Vec3 direction = Vec3::UnitZ();
  double angle = 0;
};

/// What is made small: the volume of a box, or the side of a square hole.
using Measure = double (*)(const Shadow&, const Vec2& sides);
double box_volume(const Shadow& shadow, const Vec2& sides) {
  return shadow.height * sides.prod();
}
double hole_side(const Shadow&, const Vec2& sides) {
  return sides.maxCoeff();
}

/// Tries a direction at even steps of the turn, then closes in on the best by halving the step.
Best best_turn(const Vec3& direction, const std::vector<Vec3>& points, Measure measure) {
  const Shadow shadow = shadow_along(direction, points);
  constexpr int steps = 24;  // over a quarter turn, after which the rectangle repeats
  Best here;
  here.direction = direction;
  const auto try_angle = [&](double angle) {
    const double value = measure(shadow, shadow.sides(angle));
    if (value < here.value) here.value = value, here.angle = angle;
  };
  for (int k = 0; k < steps; ++k) try_angle(k * pi / 2 / steps);
  for (const Vec2& p : shadow.outline) {  // a rectangle of least area has a side along the outline
    const Vec2& next =
        shadow.outline[static_cast<std::size_t>(&p - shadow.outline.data() + 1) % shadow.outline.size()];
    try_angle(std::atan2(next.y() - p.y(), next.x() - p.x()));
  }
  for (double step = pi / 4 / steps; step > 1e-5; step /= 2) {
    const double middle = here.angle;
    try_angle(middle - step);
    try_angle(middle + step);
  }
  return here;
}

/// Evenly spread over half a sphere (Fibonacci lattice), and the axes given.
std::vector<Vec3> directions_to_try(const Mat3& axes) {
  std::vector<Vec3> directions;
  for (int k = 0; k < 3; ++k) directions.push_back(axes.col(k));
  constexpr int count = 200;
  for (int k = 0; k < count; ++k) {
    const double z = (k + 0.5) / count, angle = k * pi * (3 - std::sqrt(5.0)), r = std::sqrt(1 - z * z);
    directions.emplace_back(r * std::cos(angle), r * std::sin(angle), z);
  }
  return directions;
}

/// Closes in on the best direction near a start by halving the step.
Best refine(Best best, const std::vector<Vec3>& points, Measure measure) {
  for (double step = 0.1; step > 1e-4;) {
    const double before = best.value;
    const Vec3 middle = best.direction.normalized(), u = middle.unitOrthogonal(), v = middle.cross(u);
    for (int k = 0; k < 6; ++k) {
      const double angle = k * pi / 3 + step * 40;  // not along the same lines at every step
      const Best there =
          best_turn(middle + step * (std::cos(angle) * u + std::sin(angle) * v), points, measure);
      if (there.value < best.value) best = there;
    }
    if (best.value >= before * (1 - 1e-3)) step /= 2;
  }
  return best;
}

Best least(const std::vector<Vec3>& directions, const std::vector<Vec3>& points, Measure measure) {
  constexpr std::size_t starts = 4;
  std::vector<Best> tried;
  for (const Vec3& direction : directions) tried.push_back(best_turn(direction, points, measure));
  std::stable_sort(tried.begin(), tried.end(),
                   [](const Best& a, const Best& b) { return a.value < b.value; });
  Best best = tried.front();
  for (std::size_t k = 0; k < std::min(starts, tried.size()); ++k) {
    const Best refined = refine(tried[k], points, measure);
    if (refined.value < best.value) best = refined;
  }
  return best;
}

/// Normals of the largest facets of the hull: the box of least volume often lies on one of them.
void add_largest_faces(const TriangleMesh& hull, std::size_t count, std::vector<Vec3>& directions) {
  std::vector<Vec3> areas;
  for (std::size_t f = 0; f < hull.facets.size(); ++f) {
    const auto [a, b, c] = hull.corners(f);
    areas.push_back((b - a).cross(c - a));
  }
  std::stable_sort(areas.begin(), areas.end(),
                   [](const Vec3& a, const Vec3& b) { return a.squaredNorm() > b.squaredNorm(); });
  for (std::size_t k = 0; k < std::min(count, areas.size()); ++k)
    if (areas[k].norm() > 0) directions.push_back(areas[k].normalized());
}

/// Rays from the origin at ascending angles, evenly spread and through points that may be corners of the
/// outline.
struct Rays {
  std::vector<double> angles;  // from -pi to pi
  std::vector<Vec2> directions;

  explicit Rays(const std::vector<Vec2>& points) {
    constexpr int even = 720;
    for (int k = 0; k < even; ++k) angles.push_back(2 * pi * k / even - pi);
    for (const Vec2& p : points)
      if (p.norm() > 0) angles.push_back(std::atan2(p.y(), p.x()));
    std::sort(angles.begin(), angles.end());
    angles.erase(std::unique(angles.begin(), angles.end()), angles.end());
    for (double angle : angles) directions.emplace_back(std::cos(angle), std::sin(angle));
  }

  /// Lengthens what the rays reach to where they cross the line from a to b. Rays that pass its ends by
  /// rounding count as crossing it there.
  void extend(const Vec2& a, const Vec2& b, std::vector<double>& reach) const {
    const double turn = cross(a, b);
    if (turn < 0) return extend(b, a, reach);
    constexpr double rounding = 1e-9;  // [rad]
    const double first = std::atan2(a.y(), a.x()) - rounding, end = std::atan2(b.y(), b.x()) + rounding;
    const double last = end < first ? end + 2 * pi : end, farthest = std::max(a.norm(), b.norm());
    for (const double seam : {-2 * pi, 0.0, 2 * pi}) {
      auto k = static_cast<std::size_t>(std::lower_bound(angles.begin(), angles.end(), first + seam) -
                                        angles.begin());
      for (; k < angles.size() && angles[k] <= last + seam; ++k) {
        const double slope = cross(directions[k], b - a);
        if (slope > 0) reach[k] = std::max(reach[k], std::min(turn / slope, farthest));
      }
    }
  }

  Outline outline(const std::vector<double>& reach) const {
    Outline outline;
    for (std::size_t k = 0; k < reach.size(); ++k) {
      const std::size_t next = (k + 1) % reach.size();
      const Vec2 p = reach[k] * directions[k], q = reach[next] * directions[next];
      outline.area += 0.5 * cross(p, q);
      outline.perimeter += (q - p).norm();
    }
    return outline;
  }
};

}  // namespace

double Outline::roundness() const {
  return 4 * pi * area / (perimeter * perimeter);
}

Outline outline_along(const TriangleMesh& solid, const Vec3& direction) {
  const Vec3 w = direction.normalized(), u = w.unitOrthogonal(), v = w.cross(u);
  Eigen::AlignedBox2d box;
  std::vector<Vec2> points;
  for (const Vec3& p : solid.vertices) {
    points.emplace_back(u.dot(p), v.dot(p));
    box.extend(points.back());
  }
  for (Vec2& p : points) p -= box.center();
  const Rays rays(points);
  std::vector<double> reach(rays.angles.size(), 0.0);
  for (const auto& facet : solid.facets)
    for (std::size_t k = 0; k < 3; ++k)
      rays.extend(points[static_cast<std::size_t>(facet[k])],
                  points[static_cast<std::size_t>(facet[(k + 1) % 3])], reach);
  return rays.outline(reach);
}

Shape measure_shape(const TriangleMesh& solid) {
  const MassProperties mass = mass_properties(solid);
  const TriangleMesh hull = convex_hull(solid);
  std::vector<Vec3> directions = directions_to_try(mass.frame);
  add_largest_faces(hull, 100, directions);

  Shape shape;
  const Best box = least(directions, hull.vertices, box_volume);
  const Shadow shadow = shadow_along(box.direction, hull.vertices);
  const Vec2 sides = shadow.sides(box.angle);
  const Vec3 u = std::cos(box.angle) * shadow.frame.col(0) + std::sin(box.angle) * shadow.frame.col(1);
  std::array<std::pair<double, Vec3>, 3> edges{
      {{sides.x(), u}, {sides.y(), shadow.frame.col(2).cross(u)}, {shadow.height, shadow.frame.col(2)}}};
  std::stable_sort(edges.begin(), edges.end(),
                   [](const auto& a, const auto& b) { return a.first > b.first; });
  shape.length = edges[0].first;
  shape.breadth = edges[1].first;
  shape.thickness = edges[2].first;
  for (int k = 0; k < 3; ++k) shape.box_axes.col(k) = edges[static_cast<std::size_t>(k)].second;
  shape.elongation = shape.breadth / shape.length;
  shape.flatness = shape.thickness / shape.breadth;
  shape.sphericity = std::cbrt(pi) * std::pow(6 * mass.volume, 2.0 / 3) / mass.area;
  shape.convexity = mass.volume / mass_properties(hull).volume;
  for (int k = 0; k < 3; ++k) shape.roundness += outline_along(solid, shape.box_axes.col(k)).roundness() / 3;
  shape.sieve_size = least(directions, hull.vertices, hole_side).value;
  return shape;
}

}  // namespace trackbed
