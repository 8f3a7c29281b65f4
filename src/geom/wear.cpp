#include "geom/wear.h"

#include <Eigen/SparseCholesky>
#include <cmath>
#include <numbers>
#include <vector>

#include "base/error.h"
#include "geom/mass_properties.h"

namespace trackbed {
namespace {

using Matrix = Eigen::SparseMatrix<double>;
using Entries = std::vector<Eigen::Triplet<double>>;

/// Area of a third of the facets around each vertex on the diagonal, and `time` times the Laplacian of the
/// surface with cotangent weights (Pinkall & Polthier 1993): its rows add up to nothing.
Matrix diffusion(const TriangleMesh& mesh, double time) {
  Entries entries;
  for (std::size_t f = 0; f < mesh.facets.size(); ++f) {
    const std::array<Vec3, 3> corners = mesh.corners(f);
    const double area2 = (corners[1] - corners[0]).cross(corners[2] - corners[0]).norm();
    for (std::size_t k = 0; k < 3; ++k) {
      const int a = mesh.facets[f][(k + 1) % 3], b = mesh.facets[f][(k + 2) % 3];
      entries.emplace_back(mesh.facets[f][k], mesh.facets[f][k], area2 / 6);
      const Vec3 to_a = corners[(k + 1) % 3] - corners[k], to_b = corners[(k + 2) % 3] - corners[k];
      const double weight = 0.5 * time * to_a.dot(to_b) / area2;  // half the cotangent of the angle at k
      entries.emplace_back(a, a, weight);
      entries.emplace_back(b, b, weight);
      entries.emplace_back(a, b, -weight);
      entries.emplace_back(b, a, -weight);
    }
  }
  const auto n = static_cast<Eigen::Index>(mesh.vertices.size());
  Matrix matrix(n, n);
  matrix.setFromTriplets(entries.begin(), entries.end());
  return matrix;
}

}  // namespace

TriangleMesh worn(const TriangleMesh& solid, double share) {
  if (share == 0) return solid;
  const MassProperties before = mass_properties(solid);
  const double radius = std::cbrt(0.75 * before.volume / std::numbers::pi);
  const auto n = static_cast<Eigen::Index>(solid.vertices.size());
  Eigen::MatrixX3d places(n, 3);
  for (Eigen::Index v = 0; v < n; ++v)
    places.row(v) = solid.vertices[static_cast<std::size_t>(v)].transpose();
  const Matrix still = diffusion(solid, 0);
  const Eigen::SimplicialLDLT<Matrix> solver(diffusion(solid, 0.5 * share * share * radius * radius));
  if (solver.info() != Eigen::Success) throw InputError("a stone with facets without area cannot be worn");
  const Eigen::MatrixX3d moved = solver.solve(still * places);

  TriangleMesh mesh = solid;
  for (Eigen::Index v = 0; v < n; ++v) mesh.vertices[static_cast<std::size_t>(v)] = moved.row(v).transpose();
  const MassProperties after = mass_properties(mesh);
  const double scale = std::cbrt(before.volume / after.volume);
  for (Vec3& v : mesh.vertices) v = before.centre + scale * (v - after.centre);
  return mesh;
}

}  // namespace trackbed
