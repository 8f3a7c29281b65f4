#include "geom/mesh_distance.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <utility>

namespace trackbed {
namespace {

struct NearestInTriangle {
  Vec3 point;
  int feature;  // as MeshDistance::Nearest
};

/// Ericson, Real-Time Collision Detection, 5.1.5.
NearestInTriangle nearest_in_triangle(const std::array<Vec3, 3>& corners, const Vec3& p) {
  const auto& [a, b, c] = corners;
  const Vec3 ab = b - a, ac = c - a, ap = p - a, bp = p - b, cp = p - c;
  const double d1 = ab.dot(ap), d2 = ac.dot(ap);
  if (d1 <= 0 && d2 <= 0) return {a, 0};
  const double d3 = ab.dot(bp), d4 = ac.dot(bp);
  if (d3 >= 0 && d4 <= d3) return {b, 1};
  const double vc = d1 * d4 - d3 * d2;
  if (vc <= 0 && d1 >= 0 && d3 <= 0) return {a + d1 / (d1 - d3) * ab, 3};
  const double d5 = ab.dot(cp), d6 = ac.dot(cp);
  if (d6 >= 0 && d5 <= d6) return {c, 2};
  const double vb = d5 * d2 - d1 * d6;
  if (vb <= 0 && d2 >= 0 && d6 <= 0) return {a + d2 / (d2 - d6) * ac, 5};
  const double va = d3 * d6 - d5 * d4;
  if (va <= 0 && d4 >= d3 && d5 >= d6) return {b + (d4 - d3) / ((d4 - d3) + (d5 - d6)) * (c - b), 4};
  return {a + vb / (va + vb + vc) * ab + vc / (va + vb + vc) * ac, 6};
}

std::vector<Sphere> bounds_of_facets(const TriangleMesh& mesh) {
  std::vector<Sphere> bounds;
  for (std::size_t f = 0; f < mesh.facets.size(); ++f) {
    const auto [a, b, c] = mesh.corners(f);
    const Vec3 centre = (a.cwiseMin(b).cwiseMin(c) + a.cwiseMax(b).cwiseMax(c)) / 2;
    bounds.push_back({centre, std::max({(a - centre).norm(), (b - centre).norm(), (c - centre).norm()})});
  }
  return bounds;
}

std::vector<std::array<Vec3, 3>> edge_normals(const TriangleMesh& mesh, const std::vector<Vec3>& normals) {
  std::map<std::pair<int, int>, Vec3> sums;
  for (std::size_t f = 0; f < mesh.facets.size(); ++f)
    for (std::size_t k = 0; k < 3; ++k)
      sums.try_emplace(std::minmax(mesh.facets[f][k], mesh.facets[f][(k + 1) % 3]), Vec3::Zero())
          .first->second += normals[f];
  std::vector<std::array<Vec3, 3>> edges(mesh.facets.size());
  for (std::size_t f = 0; f < mesh.facets.size(); ++f)
    for (std::size_t k = 0; k < 3; ++k)
      edges[f][k] = sums.at(std::minmax(mesh.facets[f][k], mesh.facets[f][(k + 1) % 3]));
  return edges;
}

}  // namespace

std::vector<Vec3> facet_normals(const TriangleMesh& mesh) {
  std::vector<Vec3> normals;
  for (std::size_t f = 0; f < mesh.facets.size(); ++f) {
    const auto [a, b, c] = mesh.corners(f);
    normals.push_back((b - a).cross(c - a).stableNormalized());
  }
  return normals;
}

std::vector<Vec3> vertex_normals(const TriangleMesh& mesh) {
  const std::vector<Vec3> flat = facet_normals(mesh);
  std::vector<Vec3> normals(mesh.vertices.size(), Vec3::Zero());
  for (std::size_t f = 0; f < mesh.facets.size(); ++f) {
    const auto corners = mesh.corners(f);
    for (std::size_t k = 0; k < 3; ++k) {
      const Vec3 u = corners[(k + 1) % 3] - corners[k], v = corners[(k + 2) % 3] - corners[k];
      normals[static_cast<std::size_t>(mesh.facets[f][k])] +=
          std::atan2(u.cross(v).norm(), u.dot(v)) * flat[f];
    }
  }
  for (Vec3& n : normals) n.stableNormalize();
  return normals;
}

MeshDistance::MeshDistance(const TriangleMesh& mesh)
    : mesh_(mesh),
      tree_(bounds_of_facets(mesh)),
      facet_normals_(facet_normals(mesh)),
      corner_normals_(vertex_normals(mesh)),
      edge_normals_(edge_normals(mesh, facet_normals_)) {}

MeshDistance::Nearest MeshDistance::nearest(const Vec3& p) const {
  Nearest best{std::numeric_limits<double>::infinity(), p, 0, 6};
  tree_.approach(
      p, [&] { return std::sqrt(best.distance2); },
      [&](int item) {
        const auto f = static_cast<std::size_t>(tree_.order()[static_cast<std::size_t>(item)]);
        const auto [q, feature] = nearest_in_triangle(mesh_.corners(f), p);
        const double d2 = (p - q).squaredNorm();
        if (d2 < best.distance2) best = {d2, q, f, feature};
      });
  return best;
}

double MeshDistance::depth(const Vec3& p) const {
  const Nearest n = nearest(p);
  const auto f = n.facet, k = static_cast<std::size_t>(n.feature);
  const Vec3& normal = k < 3   ? corner_normals_[static_cast<std::size_t>(mesh_.facets[f][k])]
                       : k < 6 ? edge_normals_[f][k - 3]
                               : facet_normals_[f];
  const double distance = std::sqrt(n.distance2);
  return normal.dot(p - n.point) > 0 ? -distance : distance;
}

}  // namespace trackbed
