#include "fem/hexahedron.h"

#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>

#include "base/error.h"
#include "fem/hex_mesh.h"

namespace trackbed::fem {
namespace {

const Elastic ballast{1.2e8, 0.2, 1800};
constexpr HexKind kinds[] = {HexKind::full, HexKind::b_bar, HexKind::incompatible};

HexNodes skew_element() {
  HexNodes x = make_block(Vec3::Zero(), Vec3::Constant(0.1), 1, 1, 1).cell_nodes(0);
  x.col(6) += Vec3(0.02, -0.01, 0.03);
  x.col(1) += Vec3(0.01, 0.02, -0.01);
  return x;
}

TEST(Hexahedron, RigidMotionAndNothingElseIsWithoutForce) {
  for (HexKind kind : kinds) {
    const HexMatrix k = hex_stiffness(skew_element(), ballast, kind);
    EXPECT_EQ(k, k.transpose());
    const HexVector w = Eigen::SelfAdjointEigenSolver<HexMatrix>(k).eigenvalues();
    EXPECT_LT(w.head<6>().cwiseAbs().maxCoeff(), 1e-12 * w[23]);
    EXPECT_GT(w[6], 1e-3 * w[23]);
  }
}

TEST(Hexahedron, MassIsVolumeTimesDensityInEachDirection) {
  const HexMatrix m = hex_mass(skew_element(), 1800);
  const auto lumped = hex_lumped_mass(skew_element(), 1800);
  HexVector up = HexVector::Zero();
  for (int a = 0; a < 8; ++a) up[3 * a + 2] = 1;
  EXPECT_NEAR(up.dot(m * up), lumped.sum(), 1e-12);
  const HexVector rows = m * up;
  for (int a = 0; a < 8; ++a) EXPECT_NEAR(rows[3 * a + 2], lumped[a], 1e-13);
  const HexNodes cube = make_block(Vec3::Zero(), Vec3::Constant(0.1), 1, 1, 1).cell_nodes(0);
  EXPECT_NEAR(hex_lumped_mass(cube, 1800)[3], 1800 * 1e-3 / 8, 1e-15);
  EXPECT_NEAR(hex_mass(cube, 1800)(0, 0), 1800 * 1e-3 / 27, 1e-15);
}

// In pure bending of one brick incompatible modes store the energy of a beam, E I / (2 R^2) a length (nu =
// 0); full integration adds shear that is not there.
TEST(Hexahedron, IncompatibleModesAreExactInBendingOfABrick) {
  const Elastic solid{1, 0, 1};
  const double a = 1, b = 1, h = 0.5;
  const HexNodes x = make_block(Vec3(-a, -b, -h), Vec3(a, b, h), 1, 1, 1).cell_nodes(0);
  HexVector u = HexVector::Zero();
  for (int n = 0; n < 8; ++n) u[3 * n] = x(0, n) * x(2, n);  // strain xx = z
  const double energy = 0.5 * (2 * a) * (2 * b) * std::pow(2 * h, 3) / 12;
  EXPECT_NEAR(0.5 * u.dot(hex_stiffness(x, solid, HexKind::incompatible) * u), energy, 1e-14);
  const double shear = 0.5 * 0.5 * (2 * b) * (2 * h) * std::pow(2 * a, 3) / 12;  // G (du/dz)^2 / 2
  EXPECT_NEAR(0.5 * u.dot(hex_stiffness(x, solid, HexKind::full) * u), energy + shear, 1e-14);
}

TEST(Hexahedron, BBarStaysSoftInShearWhenVolumeIsKept) {
  // A nearly incompressible brick in a bending mode: full integration locks, B-bar does not.
  const Elastic rubber{1, 0.4999, 1};
  const HexNodes x = make_block(-Vec3::Ones(), Vec3::Ones(), 1, 1, 1).cell_nodes(0);
  HexVector u = HexVector::Zero();
  for (int n = 0; n < 8; ++n) u[3 * n] = x(0, n) * x(2, n);
  const double full = u.dot(hex_stiffness(x, rubber, HexKind::full) * u);
  const double b_bar = u.dot(hex_stiffness(x, rubber, HexKind::b_bar) * u);
  EXPECT_GT(full, 500 * b_bar);
  // Deviatoric energy: 2 G e:e with e = z (2/3, -1/3, -1/3) and the shear strain x.
  const double g = rubber.shear_modulus(), integral = 8.0 / 3;
  EXPECT_NEAR(b_bar, (2 * g * 2 / 3 + g) * integral, 1e-9);
}

TEST(Hexahedron, InsideOutIsRefused) {
  HexNodes x = skew_element();
  x.col(0).swap(x.col(6));
  EXPECT_THROW(hex_stiffness(x, ballast, HexKind::b_bar), InputError);
}

}  // namespace
}  // namespace trackbed::fem
