#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Surface_mesh.h>
#include <CGAL/convex_hull_3.h>

#include <algorithm>
#include <numeric>

#include "base/error.h"
#include "geom/shape.h"

namespace trackbed {
namespace {

/// Puts vertices and facets in an order that depends on places alone: CGAL's follows addresses in memory, and
/// the rounding of every sum over the hull would with it.
TriangleMesh in_order(const TriangleMesh& mesh) {
  const auto is_before = [](const Vec3& a, const Vec3& b) {
    return std::lexicographical_compare(a.data(), a.data() + 3, b.data(), b.data() + 3);
  };
  std::vector<int> order(mesh.vertices.size()), place(mesh.vertices.size());
  std::iota(order.begin(), order.end(), 0);
  std::sort(order.begin(), order.end(), [&](int a, int b) {
    return is_before(mesh.vertices[static_cast<std::size_t>(a)], mesh.vertices[static_cast<std::size_t>(b)]);
  });
  TriangleMesh sorted;
  for (int v : order) {
    place[static_cast<std::size_t>(v)] = static_cast<int>(sorted.vertices.size());
    sorted.vertices.push_back(mesh.vertices[static_cast<std::size_t>(v)]);
  }
  for (std::array<int, 3> facet : mesh.facets) {
    for (int& v : facet) v = place[static_cast<std::size_t>(v)];
    std::rotate(facet.begin(), std::min_element(facet.begin(), facet.end()), facet.end());
    sorted.facets.push_back(facet);
  }
  std::sort(sorted.facets.begin(), sorted.facets.end());
  return sorted;
}

}  // namespace

TriangleMesh convex_hull(const TriangleMesh& mesh) {
  using Point = CGAL::Exact_predicates_inexact_constructions_kernel::Point_3;
  std::vector<Point> points;
  for (const Vec3& v : mesh.vertices) points.emplace_back(v.x(), v.y(), v.z());
  CGAL::Surface_mesh<Point> hull;
  if (points.size() > 3) CGAL::convex_hull_3(points.begin(), points.end(), hull);
  if (hull.number_of_faces() < 4) throw InputError("the points lie in a plane: they have no hull");
  TriangleMesh result;
  for (const auto v : hull.vertices()) {
    const Point& p = hull.point(v);
    result.vertices.emplace_back(p.x(), p.y(), p.z());
  }
  for (const auto f : hull.faces()) {
    std::vector<int> corners;
    for (const auto v : CGAL::vertices_around_face(hull.halfedge(f), hull))
      corners.push_back(static_cast<int>(static_cast<std::size_t>(v)));
    for (std::size_t k = 1; k + 1 < corners.size(); ++k)
      result.facets.push_back({corners[0], corners[k], corners[k + 1]});
  }
  return in_order(result);
}

}  // namespace trackbed
