#include "dem/wall_shape.h"

#include <algorithm>
#include <utility>

#include "base/error.h"

namespace trackbed {
namespace {

// Two closest points nearer than this fraction of the radius are one point: rounding must not make two
// contacts of one, nor may the seam of a mesh stored in single precision.
constexpr double same_point = 1e-5;
// Contacts whose normals differ by less (in radians) are one: two facets of a face that is flat but for
// noise.
constexpr double same_normal = 1e-3;

Sphere bound_of(const Facet& f) {
  // About the middle of the corners: hardly larger than the smallest one, and found at once.
  const Vec3 centre = (f.a + f.b + f.c) / 3.0;
  return {centre, std::max({(f.a - centre).norm(), (f.b - centre).norm(), (f.c - centre).norm()})};
}

struct Near {
  Vec3 point;
  double distance;
  int facet;
};

/// Whether q, the closest point of some facet, is also where every other facet that holds q comes closest.
bool is_local_minimum(const WallShape& shape, const Near* near, int n, const Near& q, double tolerance) {
  for (int k = 0; k < n; ++k) {
    const Near& other = near[k];
    if (other.facet == q.facet || (other.point - q.point).squaredNorm() <= tolerance * tolerance) continue;
    const Vec3 on_other = closest_point(shape.facets[static_cast<std::size_t>(other.facet)], q.point);
    if ((on_other - q.point).squaredNorm() <= tolerance * tolerance) return false;
  }
  return true;
}

}  // namespace

WallShape make_mesh_wall(std::string name, const TriangleMesh& mesh, const std::vector<int>& group_of_facet) {
  if (mesh.facets.empty()) throw InputError("wall " + name + " has no facet");
  std::vector<Facet> facets;
  std::vector<Sphere> bounds;
  WallShape shape;
  for (std::size_t k = 0; k < mesh.facets.size(); ++k) {
    const auto [a, b, c] = mesh.corners(k);
    const Vec3 across = (b - a).cross(c - a);
    const double area2 = across.norm();
    const double longest = std::max({(b - a).norm(), (c - b).norm(), (a - c).norm()});
    if (!(area2 > 1e-12 * longest * longest))
      throw InputError("wall " + name + ": facet " + std::to_string(k) + " has no area");
    facets.push_back({a, b, c, across / area2, group_of_facet.empty() ? 0 : group_of_facet[k]});
    bounds.push_back(bound_of(facets.back()));
    shape.reach = std::max({shape.reach, a.norm(), b.norm(), c.norm()});
  }
  shape.name = std::move(name);
  shape.mesh = mesh;
  shape.tree = SphereTree(bounds);
  for (int k : shape.tree.order()) shape.facets.push_back(facets[static_cast<std::size_t>(k)]);
  return shape;
}

WallShape make_plane_wall(std::string name, double shown_half_width) {
  WallShape shape;
  shape.name = std::move(name);
  shape.is_plane = true;
  const double w = shown_half_width;
  shape.mesh.vertices = {{-w, -w, 0}, {w, -w, 0}, {w, w, 0}, {-w, w, 0}};
  shape.mesh.facets = {{0, 1, 2}, {0, 2, 3}};
  return shape;
}

Vec3 closest_point(const Facet& f, const Vec3& p) {
  const Vec3 ab = f.b - f.a, ac = f.c - f.a, ap = p - f.a;
  const double d1 = ab.dot(ap), d2 = ac.dot(ap);
  if (d1 <= 0 && d2 <= 0) return f.a;

  const Vec3 bp = p - f.b;
  const double d3 = ab.dot(bp), d4 = ac.dot(bp);
  if (d3 >= 0 && d4 <= d3) return f.b;
  const double vc = d1 * d4 - d3 * d2;
  if (vc <= 0 && d1 >= 0 && d3 <= 0) return f.a + d1 / (d1 - d3) * ab;

  const Vec3 cp = p - f.c;
  const double d5 = ab.dot(cp), d6 = ac.dot(cp);
  if (d6 >= 0 && d5 <= d6) return f.c;
  const double vb = d5 * d2 - d1 * d6;
  if (vb <= 0 && d2 >= 0 && d6 <= 0) return f.a + d2 / (d2 - d6) * ac;

  const double va = d3 * d6 - d5 * d4;
  if (va <= 0 && d4 - d3 >= 0 && d5 - d6 >= 0) return f.b + (d4 - d3) / ((d4 - d3) + (d5 - d6)) * (f.c - f.b);

  // Inside the triangle: the projection along its normal, which does not depend on how the face is cut.
  const Vec3 normal = ab.cross(ac);
  return p - normal.dot(ap) / normal.squaredNorm() * normal;
}

int touching_points(const WallShape& shape, const int* near_facets, int n_near, const Vec3& centre,
                    double radius, WallPoints& points) {
  if (shape.is_plane) {
    if (centre.z() >= radius) return 0;
    points[0] = {{centre.x(), centre.y(), 0}, centre.z(), 0};
    return 1;
  }
  // A pebble that meets more facets than this lies on a mesh far finer than itself; the nearest ones decide.
  constexpr int most = 64;
  const auto is_nearer = [](const Near& a, const Near& b) {
    return a.distance != b.distance ? a.distance < b.distance : a.facet < b.facet;
  };
  std::array<Near, most> near;
  int n = 0;
  for (int k = 0; k < n_near; ++k) {
    const Facet& facet = shape.facets[static_cast<std::size_t>(near_facets[k])];
    if (facet.is_beyond(centre, radius)) continue;
    const Vec3 q = closest_point(facet, centre);
    const double distance2 = (q - centre).squaredNorm();
    if (!(distance2 < radius * radius)) continue;
    const Near met{q, std::sqrt(distance2), near_facets[k]};
    if (n < most) {
      near[static_cast<std::size_t>(n++)] = met;
    } else if (Near& farthest = *std::max_element(near.begin(), near.end(), is_nearer);
               is_nearer(met, farthest)) {
      farthest = met;
    }
  }
  if (n == 0) return 0;
  if (n > 1) std::sort(near.begin(), near.begin() + n, is_nearer);

  const double tolerance = same_point * radius;
  int found = 0;
  for (int k = 0; k < n && found < max_wall_points; ++k) {
    const Near& q = near[static_cast<std::size_t>(k)];
    bool is_new = true;
    for (int m = 0; m < found && is_new; ++m) {
      const double apart = (points[static_cast<std::size_t>(m)].point - q.point).norm();
      is_new = apart > std::max(tolerance, same_normal * q.distance);
    }
    // The nearest point of all is a minimum without asking.
    if (is_new && (k == 0 || is_local_minimum(shape, near.data(), n, q, tolerance)))
      points[static_cast<std::size_t>(found++)] = {q.point, q.distance, q.facet};
  }
  return found;
}

}  // namespace trackbed
