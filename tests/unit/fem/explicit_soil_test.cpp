#include "fem/explicit_soil.h"

#include <gtest/gtest.h>
#include <omp.h>

#include <Eigen/Eigenvalues>
#include <cmath>

#include "base/error.h"
#include "base/rng.h"
#include "fem/assembly.h"
#include "fem/soil_stencil.h"
#include "scenes/strip_of_soil.h"

namespace trackbed::fem {
namespace {

Eigen::VectorXd random_forces(const Soil& soil) {
  Rng rng(1, "forces");
  Eigen::VectorXd f(soil.footings() * soil.nodes_per_footing());
  for (double& value : f) value = rng.uniform(-1e3, 0);
  return f;
}

TEST(SoilStencil, GivesTheForcesOfTheAssembledMatrix) {
  for (bool whole : {false, true})
    for (HexKind kind : {HexKind::full, HexKind::b_bar, HexKind::incompatible}) {
      SoilInput in = strip_of_soil();
      in.whole_width = whole;
      in.element = kind;
      const Soil soil = make_soil(in);
      const HexMesh mesh = extrude(soil.section, 0, in.element_size, soil.planes);
      Freedoms all(soil.nodes());
      all.number();
      const SparseMatrix k = assemble_stiffness(mesh, soil.materials, kind, all);
      Rng rng(2, "displacements");
      Eigen::VectorXd u(3 * soil.nodes());
      for (double& value : u) value = rng.uniform(-1, 1);
      const Eigen::VectorXd f = k * u;

      const SoilStencil stencil(soil);
      std::vector<double> rows(stencil.size()), out(static_cast<std::size_t>(3 * soil.planes));
      for (int s = 0; s < soil.section_size(); ++s)
        for (int axis = 0; axis < 3; ++axis)
          for (int p = 0; p < soil.planes; ++p)
            stencil.row(rows.data(), s, axis)[p] = u[3 * (p * soil.section_size() + s) + axis];
      const double size = f.cwiseAbs().maxCoeff();
      for (int s = 0; s < soil.section_size(); ++s) {
        stencil.force(rows.data(), s, {out.data(), out.data() + soil.planes, out.data() + 2 * soil.planes});
        for (int axis = 0; axis < 3; ++axis)
          for (int p = 0; p < soil.planes; ++p)
            ASSERT_NEAR(out[static_cast<std::size_t>(axis * soil.planes + p)],
                        f[3 * (p * soil.section_size() + s) + axis], 1e-13 * size);
      }
    }
}

// The bound of the element is below 2/w of the mesh, and not far below; the reference's own at 75 mm.
TEST(ExplicitSoil, StepBoundIsThatOfTheFreeElement) {
  SoilInput in = strip_of_soil();
  in.length = 0.6;
  in.sleepers = 1;
  in.subgrade = in.ballast;
  const Soil soil = make_soil(in);
  const HexMesh mesh = extrude(soil.section, 0, in.element_size, soil.planes);
  Freedoms free(soil.nodes());
  for (int p = 0; p < soil.planes; ++p)
    for (int s = 0; s < soil.section_size(); ++s)
      for (int axis = 0; axis < 3; ++axis)
        if (soil.is_held(p, s, axis)) free.hold(p * soil.section_size() + s, axis);
  free.number();
  const SparseMatrix k = assemble_stiffness(mesh, soil.materials, in.element, free);
  const Eigen::VectorXd inverse =
      to_freedoms(lumped_node_masses(mesh, soil.materials), free).cwiseSqrt().cwiseInverse();
  const Eigen::MatrixXd scaled = inverse.asDiagonal() * Eigen::MatrixXd(k) * inverse.asDiagonal();
  const double w = std::sqrt(Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(scaled).eigenvalues().maxCoeff());
  const double bound = stable_time_step(soil);
  EXPECT_LT(bound, 2 / w);
  EXPECT_GT(bound, 0.8 * 2 / w);
}

TEST(ExplicitSoil, StepBoundsOfTheMaterials) {
  SoilInput in = strip_of_soil();
  in.element_size = 0.075;
  in.length = 1.2;
  in.sleeper_width = 0.225;
  in.sleeper_half_length = in.half_width = in.crest = 0.6;
  in.ballast_depth = 0.3;
  in.subgrade_depth = 0.3;
  in.sleepers = 1;
  EXPECT_NEAR(stable_time_step(make_soil(in)), 0.189e-3, 0.0005e-3);
  in.subgrade = in.ballast;
  EXPECT_NEAR(stable_time_step(make_soil(in)), 0.225e-3, 0.0005e-3);
  ExplicitSoil soil(make_soil(in));
  EXPECT_THROW(soil.start(random_forces(make_soil(in)), 0.23e-3), RunError);
}

TEST(ExplicitSoil, RestStaysRest) {
  const Soil soil = make_soil(strip_of_soil());
  const Eigen::VectorXd forces = random_forces(soil);
  ExplicitSoil moving(soil);
  moving.start(forces, stable_time_step(soil));
  const Eigen::VectorXd rest = moving.displacement();
  for (int i = 0; i < 200; ++i) moving.step(forces);
  EXPECT_LT((moving.displacement() - rest).cwiseAbs().maxCoeff(), 1e-8 * rest.cwiseAbs().maxCoeff());
}

TEST(ExplicitSoil, SameBitsOnAnyNumberOfThreads) {
  SoilInput in = strip_of_soil();
  in.stiffness_damping = 2e-5;
  const Soil soil = make_soil(in);
  const Eigen::VectorXd forces = random_forces(soil);
  Eigen::VectorXd first;
  const int before = omp_get_max_threads();
  for (int threads : {1, 2, 3}) {
    omp_set_num_threads(threads);
    ExplicitSoil moving(soil);
    moving.start(forces, stable_time_step(soil));
    for (int i = 0; i < 20; ++i) moving.step(Eigen::VectorXd(0.3 * forces));
    if (threads == 1) first = moving.displacement();
    EXPECT_EQ(moving.displacement(), first);
  }
  omp_set_num_threads(before);
}

}  // namespace
}  // namespace trackbed::fem
