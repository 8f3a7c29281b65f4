#include "geom/mass_properties.h"

#include <Eigen/Eigenvalues>

namespace trackbed {
namespace {

Mat3 principal_frame(const Mat3& axes) {
  Mat3 frame = axes;
  for (int k = 0; k < 2; ++k) {
    Eigen::Index largest = 0;
    frame.col(k).cwiseAbs().maxCoeff(&largest);
    if (frame(largest, k) < 0) frame.col(k) = -frame.col(k);
  }
  frame.col(2) = frame.col(0).cross(frame.col(1));
  return frame;
}

}  // namespace

MassProperties mass_properties(const TriangleMesh& mesh) {
  MassProperties mass;
  if (mesh.vertices.empty()) return mass;
  // A tetrahedron's second moments are J C0 J^T det J with the columns of J its edges from the apex. The apex
  // is the mean vertex, not the origin: a stone scanned far from the origin would lose digits otherwise.
  Vec3 apex = Vec3::Zero();
  for (const Vec3& v : mesh.vertices) apex += v;
  apex /= static_cast<double>(mesh.vertices.size());
  const Mat3 c0 = (Mat3() << 2, 1, 1, 1, 2, 1, 1, 1, 2).finished() / 120;

  Vec3 first = Vec3::Zero();
  Mat3 second = Mat3::Zero();
  for (std::size_t f = 0; f < mesh.facets.size(); ++f) {
    const auto [a, b, c] = mesh.corners(f);
    Mat3 edges;
    edges << a - apex, b - apex, c - apex;
    const double det = edges.determinant();
    mass.volume += det / 6;
    mass.area += (b - a).cross(c - a).norm() / 2;
    first += det / 24 * edges.rowwise().sum();
    second += det * edges * c0 * edges.transpose();
  }
  if (mass.volume == 0) return mass;
  const Vec3 offset = first / mass.volume;
  const Mat3 central = second - mass.volume * offset * offset.transpose();
  mass.centre = apex + offset;
  mass.inertia = central.trace() * Mat3::Identity() - central;
  const Eigen::SelfAdjointEigenSolver<Mat3> axes(mass.inertia);
  mass.principal = axes.eigenvalues();
  mass.frame = principal_frame(axes.eigenvectors());
  return mass;
}

TriangleMesh in_principal_frame(const TriangleMesh& mesh, const MassProperties& mass) {
  TriangleMesh moved = mesh;
  for (Vec3& v : moved.vertices) v = mass.frame.transpose() * (v - mass.centre);
  return moved;
}

}  // namespace trackbed
