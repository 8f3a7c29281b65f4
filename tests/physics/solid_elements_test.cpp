// Elements together: patches, interfaces and beams against formulas.
#include <gtest/gtest.h>

#include <cmath>
#include <functional>

#include "base/rng.h"
#include "fem/assembly.h"
#include "fem/sparse_cholesky.h"

namespace trackbed::fem {
namespace {

constexpr HexKind kinds[] = {HexKind::full, HexKind::b_bar, HexKind::incompatible};

/// Nodal displacements when those of nodes with a value are given [m] and nothing else acts.
Eigen::VectorXd solve_given(const HexMesh& mesh, const std::vector<Elastic>& solids, HexKind kind,
                            const std::function<bool(const Vec3&)>& given,
                            const std::function<Vec3(const Vec3&)>& value) {
  const int n = static_cast<int>(mesh.nodes.size());
  Freedoms all(n), free(n);
  all.number();
  Eigen::VectorXd u = Eigen::VectorXd::Zero(3 * n);
  for (int i = 0; i < n; ++i)
    if (given(mesh.nodes[static_cast<std::size_t>(i)])) {
      free.hold_all(i);
      u.segment<3>(3 * i) = value(mesh.nodes[static_cast<std::size_t>(i)]);
    }
  free.number();
  const Eigen::VectorXd force = assemble_stiffness(mesh, solids, kind, all) * u;
  Eigen::VectorXd right(free.size());
  for (int i = 0; i < n; ++i)
    for (int axis = 0; axis < 3; ++axis)
      if (free(i, axis) >= 0) right[free(i, axis)] = -force[3 * i + axis];
  return u + to_nodes(SparseCholesky(assemble_stiffness(mesh, solids, kind, free), free).solve(right), free);
}

HexVector of_cell(const HexMesh& mesh, const Eigen::VectorXd& u, std::size_t cell) {
  HexVector v;
  for (int a = 0; a < 8; ++a)
    v.segment<3>(3 * a) = u.segment<3>(3 * mesh.cells[cell][static_cast<std::size_t>(a)]);
  return v;
}

TEST(SolidElements, DistortedPatchKeepsUniformStrain) {
  const std::vector<Elastic> solids{{1.2e8, 0.2, 1800}};
  HexMesh mesh = make_block(Vec3::Zero(), Vec3::Ones(), 3, 3, 3);
  auto outside = [](const Vec3& x) { return x.minCoeff() < 1e-9 || x.maxCoeff() > 1 - 1e-9; };
  Rng rng(7, "patch");
  for (Vec3& x : mesh.nodes)
    if (!outside(x)) x += 0.08 * Vec3(rng.uniform(-1, 1), rng.uniform(-1, 1), rng.uniform(-1, 1));
  Mat3 g;
  g << 1e-3, 2e-4, -3e-4, 5e-4, -7e-4, 1e-4, 2e-4, 6e-4, 4e-4;
  Eigen::Matrix<double, 6, 1> strain;
  strain << g(0, 0), g(1, 1), g(2, 2), g(0, 1) + g(1, 0), g(1, 2) + g(2, 1), g(2, 0) + g(0, 2);
  const Eigen::Matrix<double, 6, 1> stress = solids[0].stiffness() * strain;
  for (HexKind kind : kinds) {
    const Eigen::VectorXd u =
        solve_given(mesh, solids, kind, outside, [&](const Vec3& x) { return Vec3(g * x); });
    for (std::size_t i = 0; i < mesh.nodes.size(); ++i)
      EXPECT_LT((u.segment<3>(3 * static_cast<int>(i)) - g * mesh.nodes[i]).norm(), 1e-17) << i;
    for (std::size_t c = 0; c < mesh.cells.size(); ++c)
      EXPECT_LT(
          (hex_stress(mesh.cell_nodes(static_cast<int>(c)), solids[0], of_cell(mesh, u, c)) - stress).norm(),
          1e-11 * stress.norm());
  }
}

// Ballast on subgrade, pressed without strain across: straight lines that meet, the same stress in both.
TEST(SolidElements, LayersInUniaxialStrainCarryTheSameStress) {
  const std::vector<Elastic> solids{{1.2e8, 0.2, 1800}, {1.8e8, 0.2, 1900}};
  HexMesh mesh = make_block(Vec3::Zero(), Vec3(0.3, 0.3, 0.6), 2, 2, 4);
  for (std::size_t c = 0; c < mesh.cells.size(); ++c)
    mesh.materials[c] = mesh.cell_nodes(static_cast<int>(c)).row(2).mean() < 0.3 ? 1 : 0;
  const double down = -1e-3;
  const double m0 = solids[0].constrained_modulus(), m1 = solids[1].constrained_modulus();
  const double stress = down / (0.3 / m0 + 0.3 / m1);
  auto exact = [&](const Vec3& x) {
    return Vec3(0, 0, x.z() < 0.3 ? stress * x.z() / m1 : stress * (0.3 / m1 + (x.z() - 0.3) / m0));
  };
  auto outside = [](const Vec3& x) {
    return x.minCoeff() < 1e-9 || x.z() > 0.6 - 1e-9 || std::max(x.x(), x.y()) > 0.3 - 1e-9;
  };
  EXPECT_DOUBLE_EQ(m0, 1.2e8 * 0.8 / (1.2 * 0.6));
  for (HexKind kind : kinds) {
    const Eigen::VectorXd u = solve_given(mesh, solids, kind, outside, exact);
    for (std::size_t i = 0; i < mesh.nodes.size(); ++i)
      EXPECT_LT((u.segment<3>(3 * static_cast<int>(i)) - exact(mesh.nodes[i])).norm(), 1e-17);
    for (std::size_t c = 0; c < mesh.cells.size(); ++c) {
      const Elastic& solid = solids[static_cast<std::size_t>(mesh.materials[c])];
      EXPECT_NEAR(hex_stress(mesh.cell_nodes(static_cast<int>(c)), solid, of_cell(mesh, u, c))[2], stress,
                  1e-10 * std::abs(stress));
    }
  }
}

/// Deflection of the end of a sleeper as a cantilever, over Timoshenko's.
double cantilever(int thick, int wide, HexKind kind) {
  const Elastic concrete{3.6e10, 0.2, 2500};
  const double length = 2.4, width = 0.24, height = 0.2, load = 1e4;
  const HexMesh mesh = make_block(Vec3::Zero(), Vec3(length, width, height),
                                  static_cast<int>(std::lround(length / 0.075)), wide, thick);
  Freedoms free(static_cast<int>(mesh.nodes.size()));
  for (int i = 0; i < free.nodes(); ++i)
    if (mesh.nodes[static_cast<std::size_t>(i)].x() < 1e-9) free.hold_all(i);
  Eigen::VectorXd force = Eigen::VectorXd::Zero(free.number());
  // Uniform over the end: how shear is spread there does not matter at this distance.
  double area = 0;
  for (int i = 0; i < free.nodes(); ++i) {
    const Vec3& x = mesh.nodes[static_cast<std::size_t>(i)];
    if (x.x() < length - 1e-9) continue;
    const double share =
        (x.y() < 1e-9 || x.y() > width - 1e-9 ? 0.5 : 1) * (x.z() < 1e-9 || x.z() > height - 1e-9 ? 0.5 : 1);
    force[free(i, 2)] = share;
    area += share;
  }
  force *= load / area;
  const Eigen::VectorXd u =
      SparseCholesky(assemble_stiffness(mesh, {concrete}, kind, free), free).solve(force);
  const double tip = force.dot(u) / load;
  const double nu = concrete.poisson, kappa = 10 * (1 + nu) / (12 + 11 * nu);
  const double inertia = width * std::pow(height, 3) / 12;
  const double timoshenko = load * std::pow(length, 3) / (3 * concrete.young * inertia) +
                            load * length / (kappa * concrete.shear_modulus() * width * height);
  return tip / timoshenko;
}

TEST(SolidElements, CantileverBendsLikeTimoshenkosBeam) {
  struct Row {
    int thick, wide;
    double full, b_bar, incompatible;
  };
  for (const Row& row :
       {Row{3, 3, 0.934, 0.975, 0.995}, {2, 3, 0.928, 1.027, 0.995}, {1, 3, 0.902, 2.00, 0.996}}) {
    SCOPED_TRACE(row.thick);
    EXPECT_NEAR(cantilever(row.thick, row.wide, HexKind::full), row.full, 0.002);
    EXPECT_NEAR(cantilever(row.thick, row.wide, HexKind::b_bar), row.b_bar, row.thick == 1 ? 0.01 : 0.002);
    EXPECT_NEAR(cantilever(row.thick, row.wide, HexKind::incompatible), row.incompatible, 0.002);
  }
}

}  // namespace
}  // namespace trackbed::fem
