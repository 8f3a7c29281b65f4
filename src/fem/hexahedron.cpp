#include "fem/hexahedron.h"

#include <Eigen/LU>
#include <array>
#include <cmath>

#include "base/error.h"

namespace trackbed::fem {

namespace {

using Gradients = Eigen::Matrix<double, 3, 8>;  // of the shape functions, d/dx
using StrainMatrix = Eigen::Matrix<double, 6, 24>;

const Eigen::Matrix<double, 3, 8> corners = (Eigen::Matrix<double, 3, 8>() << -1, 1, 1, -1, -1, 1, 1, -1,  //
                                             -1, -1, 1, 1, -1, -1, 1, 1,                                   //
                                             -1, -1, -1, -1, 1, 1, 1, 1)
                                                .finished();

Eigen::Matrix<double, 8, 1> shape_functions(const Vec3& local) {
  Eigen::Matrix<double, 8, 1> n;
  for (int a = 0; a < 8; ++a) n[a] = (corners.col(a).cwiseProduct(local).array() + 1).prod() / 8;
  return n;
}

Gradients local_gradients(const Vec3& local) {
  Gradients g;
  for (int a = 0; a < 8; ++a) {
    const Vec3 s = (corners.col(a).cwiseProduct(local).array() + 1).matrix();
    for (int d = 0; d < 3; ++d) g(d, a) = corners(d, a) * s[(d + 1) % 3] * s[(d + 2) % 3] / 8;
  }
  return g;
}

/// J(d, c) = d x_c / d xi_d.
Mat3 jacobian(const HexNodes& nodes, const Vec3& local) {
  return local_gradients(local) * nodes.transpose();
}

double checked_determinant(const Mat3& j) {
  const double det = j.determinant();
  if (!(det > 0)) throw InputError("a hexahedral element is turned inside out");
  return det;
}

/// Calls visit(local, weight) at the points of Gauss' rule of 2 or 3 points along each axis.
template <class Visit>
void for_gauss_points(int points, Visit visit) {
  const double a = points == 2 ? std::sqrt(1.0 / 3) : std::sqrt(0.6);
  const std::array<double, 3> place = points == 2 ? std::array{-a, a, 0.} : std::array{-a, 0., a};
  const std::array<double, 3> weight =
      points == 2 ? std::array{1., 1., 0.} : std::array{5. / 9, 8. / 9, 5. / 9};
  for (std::size_t k = 0; k < static_cast<std::size_t>(points); ++k)
    for (std::size_t j = 0; j < static_cast<std::size_t>(points); ++j)
      for (std::size_t i = 0; i < static_cast<std::size_t>(points); ++i)
        visit(Vec3(place[i], place[j], place[k]), weight[i] * weight[j] * weight[k]);
}

/// Strains of three displacements of a function with gradient g; order xx, yy, zz, xy, yz, zx.
Eigen::Matrix<double, 6, 3> strain_of(const Vec3& g) {
  Eigen::Matrix<double, 6, 3> b;
  b << g.x(), 0, 0,     //
      0, g.y(), 0,      //
      0, 0, g.z(),      //
      g.y(), g.x(), 0,  //
      0, g.z(), g.y(),  //
      g.z(), 0, g.x();
  return b;
}

StrainMatrix strain_matrix(const Gradients& g) {
  StrainMatrix b;
  for (int a = 0; a < 8; ++a) b.block<6, 3>(0, 3 * a) = strain_of(g.col(a));
  return b;
}

/// The gradients' mean over the element: what the volume strain of B-bar is made of.
Gradients mean_gradients(const HexNodes& nodes) {
  Gradients sum = Gradients::Zero();
  double volume = 0;
  for_gauss_points(2, [&](const Vec3& local, double weight) {
    const Mat3 j = jacobian(nodes, local);
    const double dv = weight * checked_determinant(j);
    sum += dv * (j.inverse() * local_gradients(local));
    volume += dv;
  });
  return sum / volume;
}

/// A third of the difference of volume strains goes to each of the three axial strains.
void replace_volume_strain(StrainMatrix& b, const Gradients& g, const Gradients& mean) {
  for (int a = 0; a < 8; ++a)
    for (int c = 0; c < 3; ++c) b.block<3, 1>(0, 3 * a + c).array() += (mean(c, a) - g(c, a)) / 3;
}

/// Modes 1 - xi_d^2. Their gradients are taken with the Jacobian at the centre and weighted with det J0 / det
/// J, so that they vanish in the mean: a patch of uniform strain does not wake them.
HexMatrix with_incompatible_modes(const HexNodes& nodes, const Mat6& d) {
  const Mat3 j0 = jacobian(nodes, Vec3::Zero());
  const Mat3 to_world = j0.inverse();
  const double det0 = checked_determinant(j0);
  HexMatrix k = HexMatrix::Zero();
  Eigen::Matrix<double, 9, 24> coupling = Eigen::Matrix<double, 9, 24>::Zero();
  Eigen::Matrix<double, 9, 9> inner = Eigen::Matrix<double, 9, 9>::Zero();
  for_gauss_points(2, [&](const Vec3& local, double weight) {
    const Mat3 j = jacobian(nodes, local);
    const double det = checked_determinant(j);
    const StrainMatrix b = strain_matrix(j.inverse() * local_gradients(local));
    Eigen::Matrix<double, 6, 9> modes;
    for (int m = 0; m < 3; ++m)
      modes.block<6, 3>(0, 3 * m) = strain_of(to_world.col(m) * (-2 * local[m] * det0 / det));
    k += weight * det * b.transpose() * d * b;
    coupling += weight * det * modes.transpose() * d * b;
    inner += weight * det * modes.transpose() * d * modes;
  });
  return k - coupling.transpose() * inner.ldlt().solve(coupling);
}

}  // namespace

HexMatrix hex_stiffness(const HexNodes& nodes, const Elastic& solid, HexKind kind) {
  const Mat6 d = solid.stiffness();
  HexMatrix k = HexMatrix::Zero();
  if (kind == HexKind::incompatible) {
    k = with_incompatible_modes(nodes, d);
  } else {
    const Gradients mean = mean_gradients(nodes);
    for_gauss_points(2, [&](const Vec3& local, double weight) {
      const Mat3 j = jacobian(nodes, local);
      const Gradients g = j.inverse() * local_gradients(local);
      StrainMatrix b = strain_matrix(g);
      if (kind == HexKind::b_bar) replace_volume_strain(b, g, mean);
      k += weight * checked_determinant(j) * b.transpose() * d * b;
    });
  }
  return (k + k.transpose()) / 2;
}

HexMatrix hex_mass(const HexNodes& nodes, double density) {
  HexMatrix m = HexMatrix::Zero();
  for_gauss_points(3, [&](const Vec3& local, double weight) {
    const Eigen::Matrix<double, 8, 1> n = shape_functions(local);
    const double dm = density * weight * checked_determinant(jacobian(nodes, local));
    for (int a = 0; a < 8; ++a)
      for (int b = 0; b < 8; ++b) m.block<3, 3>(3 * a, 3 * b).diagonal().array() += dm * n[a] * n[b];
  });
  return m;
}

Eigen::Matrix<double, 8, 1> hex_lumped_mass(const HexNodes& nodes, double density) {
  Eigen::Matrix<double, 8, 1> m = Eigen::Matrix<double, 8, 1>::Zero();
  for_gauss_points(2, [&](const Vec3& local, double weight) {
    m += density * weight * checked_determinant(jacobian(nodes, local)) * shape_functions(local);
  });
  return m;
}

Eigen::Matrix<double, 6, 1> hex_stress(const HexNodes& nodes, const Elastic& solid, const HexVector& u) {
  const Mat3 j = jacobian(nodes, Vec3::Zero());
  return solid.stiffness() * (strain_matrix(j.inverse() * local_gradients(Vec3::Zero())) * u);
}

}  // namespace trackbed::fem
