#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Surface_mesh.h>
#include <CGAL/convex_hull_3.h>

#include "base/error.h"
#include "geom/shape.h"

namespace trackbed {

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
  return result;
}

}  // namespace trackbed
