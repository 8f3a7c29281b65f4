#include <algorithm>
#include <cmath>
#include <numeric>

#include "dem/touching.h"
#include "lab/in_touch.h"
#include "lab/measures/measures.h"
#include "lab/room.h"

namespace trackbed {
namespace {

using Index = std::size_t;

/// Vertical lines through the middles of square cells; what they meet last, from below.
class Surface {
 public:
  static constexpr double cell = 0.02;  // [m]

  explicit Surface(const Eigen::AlignedBox2d& where)
      : low_(where.min()), nx_(count(where.sizes().x())), ny_(count(where.sizes().y())) {
    step_ = {where.sizes().x() / nx_, where.sizes().y() / ny_};
    height_.assign(static_cast<Index>(nx_ * ny_), 0.0);
    covered_.assign(height_.size(), false);
    left_out_.assign(height_.size(), false);
  }

  void add_ball(const Vec3& centre, double radius) {
    for_lines(centre.head<2>().array() - radius, centre.head<2>().array() + radius,
              [&](Index k, const Eigen::Vector2d& line) {
                const double rise2 = radius * radius - (line - centre.head<2>()).squaredNorm();
                if (rise2 > 0) height_[k] = std::max(height_[k], centre.z() + std::sqrt(rise2));
              });
  }

  /// The lines through a facet say nothing of the free surface.
  void cover(const std::array<Vec3, 3>& corners) {
    const Eigen::Vector2d a = corners[0].head<2>(), b = corners[1].head<2>(), c = corners[2].head<2>();
    const auto side = [](const Eigen::Vector2d& p, const Eigen::Vector2d& q, const Eigen::Vector2d& r) {
      return (q - p).x() * (r - p).y() - (q - p).y() * (r - p).x();
    };
    for_lines(a.cwiseMin(b).cwiseMin(c), a.cwiseMax(b).cwiseMax(c),
              [&](Index k, const Eigen::Vector2d& line) {
                const double u = side(a, b, line), v = side(b, c, line), w = side(c, a, line);
                if ((u >= 0 && v >= 0 && w >= 0) || (u <= 0 && v <= 0 && w <= 0)) covered_[k] = true;
              });
  }

  /// Lines that are no part of the surface.
  template <class Ends>
  void leave_out(Ends&& is_left_out) {
    for (Index k = 0; k < height_.size(); ++k) {
      const int i = static_cast<int>(k) % nx_, j = static_cast<int>(k) / nx_;
      left_out_[k] = is_left_out(line(i, j));
    }
  }

  /// Mean of the free lines, a tenth of the highest dropped; of those below bodies too when none is free.
  double mean() const {
    std::vector<double> free, all;
    for (Index k = 0; k < height_.size(); ++k) {
      if (left_out_[k]) continue;
      all.push_back(height_[k]);
      if (!covered_[k]) free.push_back(height_[k]);
    }
    if (free.empty()) free = all.empty() ? height_ : all;
    std::ranges::sort(free);
    free.resize(free.size() - free.size() / 10);
    return std::accumulate(free.begin(), free.end(), 0.0) / static_cast<double>(free.size());
  }

 private:
  Eigen::Vector2d line(int i, int j) const {
    return {low_.x() + (i + 0.5) * step_.x(), low_.y() + (j + 0.5) * step_.y()};
  }

  static int count(double length) { return std::max(1, static_cast<int>(std::lround(length / cell))); }

  /// Index of the first line at or after x along an axis.
  static int first(double x, double low, double step, int n) {
    return static_cast<int>(std::clamp(std::ceil((x - low) / step - 0.5), 0.0, static_cast<double>(n)));
  }

  template <class Visit>
  void for_lines(const Eigen::Array2d& low, const Eigen::Array2d& high, Visit&& visit) const {
    const int i1 = first(high.x(), low_.x(), step_.x(), nx_), j1 = first(high.y(), low_.y(), step_.y(), ny_);
    for (int j = first(low.y(), low_.y(), step_.y(), ny_); j < j1; ++j)
      for (int i = first(low.x(), low_.x(), step_.x(), nx_); i < i1; ++i)
        visit(static_cast<Index>(j * nx_ + i), line(i, j));
  }

  Eigen::Vector2d low_, step_;
  int nx_, ny_;
  std::vector<double> height_;  // above z = 0 [m]
  std::vector<bool> covered_, left_out_;
};

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

double bed_surface(const Simulation& sim, const Eigen::AlignedBox2d& where) {
  Eigen::AlignedBox2d lines = where;
  if (sim.model.space.is_plane()) lines.min().y() = lines.max().y() = 0;  // discs reach through the thickness
  Surface surface(lines);
  if (!sim.trays.empty())
    surface.leave_out([&](const Eigen::Vector2d& line) { return ends_at_a_rim(sim, line); });
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
  return surface.mean();
}

double solid_volume(const Simulation& sim) {
  double sum = 0;
  for (Index i = 0; i < sim.state.clumps.id.size(); ++i) sum += volume_of(sim, i);
  return sum;
}

double largest_displacement(const Simulation& sim) {
  double largest = 0;
  for (const Vec3& moved : displacements(sim.state, sim.places)) largest = std::max(largest, moved.norm());
  return largest;
}

double weight(const Simulation& sim) {
  const std::vector<double>& masses = sim.state.clumps.mass;
  double mass = std::accumulate(masses.begin(), masses.end(), 0.0);
  for (Index w = 0; w < sim.model.walls.size(); ++w)
    if (sim.model.walls[w].body && sim.state.walls[w].present) mass += sim.model.walls[w].body->mass;
  return mass * sim.model.gravity.norm();
}

double median_size(const Simulation& sim) {
  const Clumps& c = sim.state.clumps;
  std::vector<std::pair<double, double>> stones;  // diameter, mass
  double total = 0;
  for (Index i = 0; i < c.id.size(); ++i) {
    stones.emplace_back(2 * equal_volume_radius(sim, i), c.mass[i]);
    total += c.mass[i];
  }
  std::ranges::sort(stones);
  double finer = 0;
  for (const auto& [diameter, mass] : stones)
    if ((finer += mass) >= 0.5 * total) return diameter;
  return 0.0;
}

double bed_height(const Simulation& sim) {
  const Eigen::AlignedBox3d box = container_now(sim);
  return bed_surface(sim, {box.min().head<2>(), box.max().head<2>()});
}

double volume_below(const WallShape& shape, const Pose& pose, double z) {
  // Divergence theorem for the field (0, 0, min(height - z, 0)): each facet adds its shadow times its mean
  // depth, the facets through z only their part below.
  double volume = 0;
  for (Index f = 0; f < shape.mesh.facets.size(); ++f) {
    const auto corners = shape.mesh.corners(f);
    std::vector<Vec3> below;
    for (Index k = 0; k < 3; ++k) {
      const Vec3 p = pose.to_world(corners[k]) - Vec3(0, 0, z),
                 q = pose.to_world(corners[(k + 1) % 3]) - Vec3(0, 0, z);
      if (p.z() <= 0) below.push_back(p);
      if ((p.z() < 0) != (q.z() < 0) && p.z() != 0 && q.z() != 0)
        below.push_back(p + p.z() / (p.z() - q.z()) * (q - p));
    }
    for (Index k = 2; k < below.size(); ++k) {
      const double shadow = 0.5 * (below[k - 1] - below[0]).cross(below[k] - below[0]).z();
      volume += shadow * (below[0].z() + below[k - 1].z() + below[k].z()) / 3.0;
    }
  }
  return volume;
}

double pebble_volume(const Simulation& sim) {
  const Clumps& c = sim.state.clumps;
  double sum = 0;
  for (Index i = 0; i < c.id.size(); ++i)
    sum += sim.model.templates[static_cast<Index>(c.shape[i])].pebble_volume *
           sim.model.space.growth_of_volume(c.scale[i]);
  return sum;
}

double bed_volume(const Simulation& sim) {
  const double height = bed_height(sim);
  Eigen::AlignedBox3d below = container_now(sim);
  below.max().z() = height;
  if (sim.container_mesh >= 0 || !sim.trays.empty())
    return height > below.min().z() ? volume_in(below, [&](const Vec3& x) { return is_in_room(sim, x); })
                                    : 0.0;
  double volume = below.sizes().prod();
  for (Index w = 0; w < sim.model.walls.size(); ++w)
    if (sim.model.walls[w].body && sim.state.walls[w].present)
      volume -= volume_below(sim.model.walls[w].shape, sim.state.walls[w].pose, height);
  return volume;
}

double porosity(const Simulation& sim, double solid) {
  return solid == 0 ? 1.0 : 1.0 - solid / bed_volume(sim);
}

BedStress bed_stress(const Simulation& sim) {
  BedStress stress;
  if (sim.container.isEmpty() || sim.state.clumps.size() == 0) return stress;
  stress.volume = bed_volume(sim);
  visit_touching(sim.model, sim.state, [&](const Touching& t) {
    const Vec3 branch = t.clump_2 >= 0 ? Vec3(t.lever_1 - t.lever_2) : t.lever_1;
    const double along = branch.dot(t.normal);
    stress.mean += t.force().dot(branch) / (sim.model.space.dimensions() * stress.volume);
    stress.stiffness += t.properties->kn * along * along;
  });
  return stress;
}

}  // namespace trackbed
