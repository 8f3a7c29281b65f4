#include "geom/surface_samples.h"

#include <algorithm>
#include <cmath>

#include "geom/mesh_distance.h"

namespace trackbed {

std::vector<SurfaceSample> sample_surface(const TriangleMesh& mesh, int count) {
  const std::vector<Vec3> normals = facet_normals(mesh);
  std::vector<double> area_up_to;  // that facet's included
  double area = 0;
  for (std::size_t f = 0; f < mesh.facets.size(); ++f) {
    const auto [a, b, c] = mesh.corners(f);
    area_up_to.push_back(area += (b - a).cross(c - a).norm() / 2);
  }
  constexpr double step_u = 0.7548776662466927, step_v = 0.5698402909980532;  // 1/g, 1/g^2; g^3 = g + 1
  std::vector<SurfaceSample> samples;
  std::size_t f = 0;
  for (int k = 0; k < count && area > 0; ++k) {
    while (f + 1 < area_up_to.size() && area_up_to[f] <= area * (k + 0.5) / count) ++f;
    const auto [a, b, c] = mesh.corners(f);
    double whole = 0;
    double u = std::modf(0.5 + k * step_u, &whole), v = std::modf(0.5 + k * step_v, &whole);
    if (u + v > 1) u = 1 - u, v = 1 - v;
    samples.push_back({a + u * (b - a) + v * (c - a), normals[f]});
  }
  return samples;
}

}  // namespace trackbed
