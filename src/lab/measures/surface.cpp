#include "lab/measures/surface.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "dem/overlap.h"
#include "lab/measures/measures.h"
#include "lab/room.h"

namespace trackbed {
namespace {

using Index = std::size_t;

/// Mean of some numbers without the highest tenth of them.
double mean_of_lower(std::vector<double> values) {
  std::ranges::sort(values);
  const double kept = 0.9 * static_cast<double>(values.size());
  double sum = 0;
  for (Index k = 0; k < values.size(); ++k)
    sum += values[k] * std::clamp(kept - static_cast<double>(k), 0.0, 1.0);
  return sum / kept;
}

/// Index of the first line at or after x along an axis.
int first(double x, double low, double step, int n) {
  return static_cast<int>(std::clamp(std::ceil((x - low) / step - 0.5), 0.0, static_cast<double>(n)));
}

int lines_along(double length) {
  return std::max(1, static_cast<int>(std::lround(length / Surface::cell)));
}

/// A grid of squares, some of which have no value.
struct Patches {
  int nx, ny;
  std::vector<std::optional<double>> value;

  /// Of a square, or the mean of the nearest that have one, ring by ring.
  double nearest(int i, int j) const {
    for (int ring = 0; ring < std::max(nx, ny); ++ring) {
      double sum = 0;
      int n = 0;
      for (int q = std::max(j - ring, 0); q <= std::min(j + ring, ny - 1); ++q)
        for (int p = std::max(i - ring, 0); p <= std::min(i + ring, nx - 1); ++p)
          if (const auto& v = value[static_cast<Index>(q * nx + p)]) sum += *v, ++n;
      if (n > 0) return sum / n;
    }
    return 0.0;
  }
};

/// Whether a vertical line lies outside a closed container.
bool misses_container(const Simulation& sim, const Eigen::Vector2d& line) {
  const WallShape& shape = sim.model.walls[static_cast<Index>(sim.container_mesh)].shape;
  const Pose& pose = sim.state.walls[static_cast<Index>(sim.container_mesh)].pose;
  const Eigen::AlignedBox3d box = container_now(sim);
  const double step = 0.5 * Surface::cell;
  for (double z = box.min().z() + 0.5 * step; z < box.max().z(); z += step)
    if (is_inside(shape, pose.to_body({line.x(), line.y(), z}))) return false;
  return true;
}

/// Whether a vertical line meets a rim above which the container does not go on: what lies below is no
/// surface.
bool ends_at_a_rim(const Simulation& sim, const Eigen::Vector2d& line) {
  constexpr double just_above = 1e-6;  // [m]
  return std::ranges::any_of(sim.trays, [&](const Tray& tray) {
    const WallState& wall = sim.state.walls[static_cast<Index>(tray.wall)];
    if (!wall.present || tray.rim == 0) return false;
    const Vec3 at(line.x(), line.y(), wall.pose.position.z() + tray.rim_height + just_above);
    const Eigen::Vector2d seen = wall.pose.to_body(at).head<2>();
    const Eigen::AlignedBox2d hole(tray.inside.min().head<2>(), tray.inside.max().head<2>());
    const Eigen::Vector2d rim = Eigen::Vector2d::Constant(tray.rim);
    const Eigen::AlignedBox2d edge(hole.min() - rim, hole.max() + rim);
    return edge.contains(seen) && !hole.contains(seen) && !is_in_room(sim, at);
  });
}

}  // namespace

double LocalHeights::at(const Eigen::Vector2d& place) const {
  const auto number = [&](int axis, int n) {
    const double size = lines_.where.sizes()[axis];
    if (size <= 0) return 0;
    const double share = (place[axis] - lines_.where.min()[axis]) / size;
    return std::clamp(static_cast<int>(std::floor(share * n)), 0, n - 1);
  };
  return heights_[lines_.index(number(0, lines_.nx), number(1, lines_.ny))];
}

double LocalHeights::mean() const {
  return std::accumulate(heights_.begin(), heights_.end(), 0.0) / static_cast<double>(heights_.size());
}

double LocalHeights::highest() const {
  return *std::ranges::max_element(heights_);
}

double LocalHeights::mean_over(const Eigen::AlignedBox2d& part) const {
  double sum = 0;
  int n = 0;
  lines_.for_each([&](int i, int j) {
    if (!part.contains(lines_.line(i, j))) return;
    sum += heights_[lines_.index(i, j)];
    ++n;
  });
  return n > 0 ? sum / n : at(part.center());
}

Surface::Surface(const Eigen::AlignedBox2d& where, double floor)
    : lines_{where, lines_along(where.sizes().x()), lines_along(where.sizes().y())},
      height_(lines_.size(), floor),
      covered_(lines_.size(), false),
      left_out_(lines_.size(), false) {}

template <class Visit>
void Surface::for_lines(const Eigen::Array2d& low, const Eigen::Array2d& high, Visit&& visit) const {
  const Eigen::Vector2d from = lines_.where.min(), size = lines_.where.sizes();
  const auto first_x = [&](double x) { return first(x, from.x(), size.x() / lines_.nx, lines_.nx); };
  const auto first_y = [&](double y) { return first(y, from.y(), size.y() / lines_.ny, lines_.ny); };
  const int i1 = first_x(high.x()), j1 = first_y(high.y());
  for (int j = first_y(low.y()); j < j1; ++j)
    for (int i = first_x(low.x()); i < i1; ++i) visit(lines_.index(i, j), lines_.line(i, j));
}

void Surface::add_ball(const Vec3& centre, double radius) {
  for_lines(centre.head<2>().array() - radius, centre.head<2>().array() + radius,
            [&](Index k, const Eigen::Vector2d& line) {
              const double rise2 = radius * radius - (line - centre.head<2>()).squaredNorm();
              if (rise2 > 0) height_[k] = std::max(height_[k], centre.z() + std::sqrt(rise2));
            });
}

void Surface::cover(const std::array<Vec3, 3>& corners) {
  const Eigen::Vector2d a = corners[0].head<2>(), b = corners[1].head<2>(), c = corners[2].head<2>();
  const auto side = [](const Eigen::Vector2d& p, const Eigen::Vector2d& q, const Eigen::Vector2d& r) {
    return (q - p).x() * (r - p).y() - (q - p).y() * (r - p).x();
  };
  for_lines(a.cwiseMin(b).cwiseMin(c), a.cwiseMax(b).cwiseMax(c), [&](Index k, const Eigen::Vector2d& line) {
    const double u = side(a, b, line), v = side(b, c, line), w = side(c, a, line);
    if ((u >= 0 && v >= 0 && w >= 0) || (u <= 0 && v <= 0 && w <= 0)) covered_[k] = true;
  });
}

std::vector<bool> Surface::telling() const {
  std::vector<bool> free(height_.size()), any(height_.size());
  for (Index k = 0; k < height_.size(); ++k) {
    any[k] = !left_out_[k];
    free[k] = any[k] && !covered_[k];
  }
  const auto has_one = [](const std::vector<bool>& lines) {
    return std::ranges::find(lines, true) != lines.end();
  };
  if (has_one(free)) return free;
  return has_one(any) ? any : std::vector<bool>(height_.size(), true);
}

double Surface::mean() const {
  const std::vector<bool> tells = telling();
  std::vector<double> heights;
  for (Index k = 0; k < height_.size(); ++k)
    if (tells[k]) heights.push_back(height_[k]);
  return mean_of_lower(std::move(heights));
}

LocalHeights Surface::local() const {
  const std::vector<bool> tells = telling();
  const auto count = [](int lines) { return (lines + patch - 1) / patch; };
  Patches patches{count(lines_.nx), count(lines_.ny), {}};
  const auto column = [&](int i) { return i * patches.nx / lines_.nx; };
  const auto row = [&](int j) { return j * patches.ny / lines_.ny; };
  std::vector<std::vector<double>> heights(static_cast<Index>(patches.nx * patches.ny));
  lines_.for_each([&](int i, int j) {
    const Index k = lines_.index(i, j);
    if (tells[k]) heights[static_cast<Index>(row(j) * patches.nx + column(i))].push_back(height_[k]);
  });
  for (std::vector<double>& h : heights)
    patches.value.push_back(h.empty() ? std::nullopt : std::optional(mean_of_lower(std::move(h))));
  std::vector<double> all;
  lines_.for_each([&](int i, int j) { all.push_back(patches.nearest(column(i), row(j))); });
  return {lines_, std::move(all)};
}

Surface surface_of(const Simulation& sim, const Eigen::AlignedBox2d& where) {
  Eigen::AlignedBox2d lines = where;
  if (sim.model.space.is_plane()) lines.min().y() = lines.max().y() = 0;  // discs reach through the thickness
  Surface surface(lines, sim.container.isEmpty() ? 0.0 : container_now(sim).min().z());
  if (!sim.trays.empty())
    surface.leave_out([&](const Eigen::Vector2d& line) { return ends_at_a_rim(sim, line); });
  if (sim.container_mesh >= 0)
    surface.leave_out([&](const Eigen::Vector2d& line) { return misses_container(sim, line); });
  const Clumps& c = sim.state.clumps;
  for (Index i = 0; i < c.id.size(); ++i) {
    for (const Pebble& pebble : sim.model.templates[static_cast<Index>(c.shape[i])].pebbles) {
      const Vec3 centre = c.position[i] + c.orientation[i] * (c.scale[i] * pebble.centre);
      surface.add_ball(centre, c.scale[i] * pebble.radius);
    }
  }
  for (Index w = 0; w < sim.model.walls.size(); ++w) {
    const Wall& wall = sim.model.walls[w];
    const Pose& pose = sim.state.walls[w].pose;
    if (!wall.body || !sim.state.walls[w].present) continue;
    for (Index f = 0; f < wall.shape.mesh.facets.size(); ++f) {
      const auto [a, b, d] = wall.shape.mesh.corners(f);
      surface.cover({pose.to_world(a), pose.to_world(b), pose.to_world(d)});
    }
  }
  return surface;
}

Eigen::AlignedBox2d footprint(const Eigen::AlignedBox3d& box) {
  return {box.min().head<2>(), box.max().head<2>()};
}

Eigen::AlignedBox2d footprint(const WallShape& shape, const Pose& pose) {
  Eigen::AlignedBox2d seen;
  for (const Vec3& corner : shape.mesh.vertices) seen.extend(pose.to_world(corner).head<2>());
  return seen;
}

double bed_surface(const Simulation& sim, const Eigen::AlignedBox2d& where) {
  return surface_of(sim, where).mean();
}

double bed_height(const Simulation& sim) {
  return bed_surface(sim, footprint(container_now(sim)));
}

}  // namespace trackbed
