#include "geom/clump_fill.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nanoflann.hpp>
#include <numbers>
#include <utility>

#include "base/error.h"
#include "geom/mass_properties.h"
#include "geom/mesh_distance.h"
#include "geom/surface_samples.h"

namespace trackbed {
namespace {

/// Nearest-sample search.
class SampleTree {
 public:
  explicit SampleTree(const std::vector<SurfaceSample>& samples)
      : samples_(samples), index_(3, *this, {16}) {}

  /// The sample nearest to p among those closer than the square root of `within2`; -1 for none.
  int nearest(const Vec3& p, double within2) const {
    Nearest best{within2};
    index_.findNeighbors(best, p.data(), {});
    return best.index;
  }

  const Vec3& point(std::size_t k) const { return samples_[k].point; }

  // What nanoflann asks for.
  std::size_t kdtree_get_point_count() const { return samples_.size(); }
  double kdtree_get_pt(std::size_t k, std::size_t axis) const {
    return samples_[k].point[static_cast<Eigen::Index>(axis)];
  }
  template <class Box>
  bool kdtree_get_bbox(Box&) const {
    return false;
  }

 private:
  struct Nearest {  // a result set of nanoflann
    double distance2;
    int index = -1;
    double worstDist() const { return distance2; }
    bool full() const { return true; }
    bool addPoint(double d2, unsigned k) {
      if (d2 < distance2) *this = {d2, static_cast<int>(k)};
      return true;
    }
  };
  const std::vector<SurfaceSample>& samples_;
  nanoflann::KDTreeSingleIndexAdaptor<nanoflann::L2_Simple_Adaptor<double, SampleTree>, SampleTree, 3> index_;
};

/// No ball inside the mesh is larger than this: half the least side of its box.
double radius_limit(const TriangleMesh& mesh) {
  Eigen::AlignedBox3d box;
  for (const Vec3& v : mesh.vertices) box.extend(v);
  return box.sizes().minCoeff() / 2;
}

constexpr double shrinking_stops = 0.999;  // a sample this deep inside a ball, in its radii, is let in

/// The largest ball that touches the surface at the sample from inside and holds no other sample. Stops
/// shrinking below `least`.
Pebble shrunken_ball(const SurfaceSample& sample, const SampleTree& tree, double first, double least) {
  double radius = first;
  while (radius >= least) {
    const Vec3 centre = sample.point - radius * sample.normal;
    const int q = tree.nearest(centre, std::pow(shrinking_stops * radius, 2));
    if (q < 0) break;
    // The ball through p and q with its centre on the normal of p; q lies inside the old ball, so it is
    // smaller.
    const Vec3 pq = tree.point(static_cast<std::size_t>(q)) - sample.point;
    radius = pq.squaredNorm() / (-2 * sample.normal.dot(pq));
  }
  return {sample.point - radius * sample.normal, radius};
}

/// No pebble may stick out of the mesh by more than the radius factor allows.
bool lies_inside(const Pebble& ball, const MeshDistance& mesh, double radius_factor) {
  return radius_factor * mesh.depth(ball.centre) >= ball.radius;
}

/// Balls that touch the samples in two places, largest first; those that Ratio would refuse are left out.
std::vector<Pebble> medial_balls(const TriangleMesh& solid, const ClumpFilling& filling,
                                 const MeshDistance& mesh, int samples) {
  const std::vector<SurfaceSample> surface = sample_surface(solid, samples);
  const SampleTree tree(surface);
  const double first = radius_limit(solid);
  Pebble largest{Vec3::Zero(), 0};
  std::vector<std::pair<Pebble, std::size_t>> found;
  // Every 31st sample first, so that the largest radius is soon known and small balls need not be finished.
  constexpr std::size_t stride = 31;
  for (std::size_t offset = 0; offset < stride; ++offset) {
    for (std::size_t k = offset; k < surface.size(); k += stride) {
      // A smooth point of the surface has one such ball. That of a round stone, which would take long to find
      // anew from every sample, is known by now.
      const double off = (surface[k].point - largest.centre).norm() - largest.radius;
      if (std::abs(off) <= (1 - shrinking_stops) * largest.radius) continue;
      const Pebble ball = shrunken_ball(surface[k], tree, first, filling.ratio * largest.radius);
      if (ball.radius < filling.ratio * largest.radius) continue;
      found.emplace_back(ball, k);
      if (ball.radius > largest.radius && lies_inside(ball, mesh, filling.radius_factor)) largest = ball;
    }
  }
  std::erase_if(found, [&](const auto& f) { return f.first.radius < filling.ratio * largest.radius; });
  std::sort(found.begin(), found.end(), [](const auto& a, const auto& b) {
    return a.first.radius != b.first.radius ? a.first.radius > b.first.radius : a.second < b.second;
  });
  std::vector<Pebble> balls;
  for (const auto& [ball, k] : found) balls.push_back(ball);
  return balls;
}

/// The pebbles kept so far, found by place. As balls come in descending order, a kept pebble of radius s can
/// only stand in the way of a ball whose centre is within its reach: s, or s sqrt(2 + 2 cos Distance) if that
/// is more.
class KeptPebbles {
 public:
  KeptPebbles(const std::vector<Pebble>& balls, double distance) : cos_distance_(std::cos(distance)) {
    for (const Pebble& ball : balls) box_.extend(ball.centre);
    cell_ = std::max(box_.sizes().maxCoeff() / cells, 1e-300);
    grid_.resize(cells * cells * cells);
  }

  bool leaves_room_for(const Pebble& ball) const {
    for (int k : grid_[cell_number(ball.centre)])
      if (blocks(pebbles_[static_cast<std::size_t>(k)], ball)) return false;
    return true;
  }

  void add(const Pebble& ball) {
    const double reach = ball.radius * std::sqrt(std::max(1.0, 2 + 2 * cos_distance_));
    const auto low = cell_of(ball.centre - Vec3::Constant(reach)),
               high = cell_of(ball.centre + Vec3::Constant(reach));
    for (int z = low[2]; z <= high[2]; ++z)
      for (int y = low[1]; y <= high[1]; ++y)
        for (int x = low[0]; x <= high[0]; ++x)
          grid_[number({x, y, z})].push_back(static_cast<int>(pebbles_.size()));
    pebbles_.push_back(ball);
  }

  const std::vector<Pebble>& pebbles() const { return pebbles_; }

 private:
  static constexpr int cells = 32;
  using Cell = std::array<int, 3>;

  bool blocks(const Pebble& kept, const Pebble& ball) const {
    const double d2 = (kept.centre - ball.centre).squaredNorm(), r = ball.radius, s = kept.radius;
    return d2 <= (s - r) * (s - r) || d2 < r * r + s * s + 2 * r * s * cos_distance_;
  }
  Cell cell_of(const Vec3& p) const {
    Cell cell{};
    for (Eigen::Index k = 0; k < 3; ++k)
      cell[static_cast<std::size_t>(k)] =
          static_cast<int>(std::clamp((p[k] - box_.min()[k]) / cell_, 0.0, cells - 1.0));
    return cell;
  }
  static std::size_t number(const Cell& c) {
    return static_cast<std::size_t>((c[2] * cells + c[1]) * cells + c[0]);
  }
  std::size_t cell_number(const Vec3& p) const { return number(cell_of(p)); }

  double cos_distance_, cell_ = 0;
  Eigen::AlignedBox3d box_;
  std::vector<std::vector<int>> grid_;
  std::vector<Pebble> pebbles_;
};

/// Samples must lie closer than the smallest pebbles will, and close enough to find corners within 2 %.
int enough_samples(const TriangleMesh& solid, const ClumpFilling& filling) {
  const MassProperties mass = mass_properties(solid);
  const double smallest = filling.ratio * 3 * mass.volume / mass.area;  // 3 V / A: the radius, for a ball
  const double gap = smallest * std::min(0.1, std::cos(filling.distance / 2) * 2 / 3);
  return static_cast<int>(std::clamp(mass.area / (gap * gap), 20'000.0, 400'000.0));
}

void check(const ClumpFilling& filling) {
  const double degrees = filling.distance * 180 / std::numbers::pi;
  if (!(degrees >= 0 && degrees <= 180))
    throw InputError(fmt::format("Distance is an angle from 0 to 180 degrees, not {:g}", degrees));
  if (!(filling.ratio > 0 && filling.ratio <= 1))
    throw InputError(fmt::format("Ratio lies above 0 and is at most 1, it cannot be {:g}", filling.ratio));
  if (!(filling.radius_factor >= 1))
    throw InputError(fmt::format("the radius factor is at least 1, not {:g}", filling.radius_factor));
  if (filling.max_pebbles < 0 || filling.samples < 0)
    throw InputError("the numbers of pebbles and of surface samples cannot be negative");
}

}  // namespace

double angle_between(const Pebble& a, const Pebble& b) {
  const double d2 = (a.centre - b.centre).squaredNorm();
  const double cosine = (d2 - a.radius * a.radius - b.radius * b.radius) / (2 * a.radius * b.radius);
  return std::acos(std::clamp(cosine, -1.0, 1.0));
}

std::vector<Pebble> fill_with_pebbles(const TriangleMesh& solid, const ClumpFilling& filling) {
  check(filling);
  const int samples = filling.samples ? filling.samples : enough_samples(solid, filling);
  const MeshDistance mesh(solid);
  const std::vector<Pebble> balls = medial_balls(solid, filling, mesh, samples);
  KeptPebbles kept(balls, filling.distance);
  for (const Pebble& ball : balls) {
    if (!kept.leaves_room_for(ball) || !lies_inside(ball, mesh, filling.radius_factor)) continue;
    kept.add(ball);
    if (static_cast<int>(kept.pebbles().size()) == filling.max_pebbles) break;
  }
  return kept.pebbles();
}

}  // namespace trackbed
