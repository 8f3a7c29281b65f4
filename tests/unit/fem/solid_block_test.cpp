#include "fem/solid_block.h"

#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "fem/beam.h"

namespace trackbed::fem {
namespace {

constexpr double young = 3.6e10, poisson = 0.2, density = 2400;
constexpr double length = 2.4, width = 0.24, height = 0.2;

double shear_area() {
  return 10 * (1 + poisson) / (12 + 11 * poisson) * width * height;
}  // Cowper (1966)

SolidBlock half_sleeper() {
  return {{-width / 2, 0, 0}, {width / 2, length / 2, height}, 0.075, {young, poisson, density}};
}

/// Halves of its base and the rail seat.
std::vector<FacePatch> sleeper_ports() {
  return {{-width / 2, width / 2, 0, length / 4, false},
          {-width / 2, width / 2, length / 4, length / 2, false},
          {-width / 2, width / 2, 0.68, 0.82, true}};
}

/// Frequencies of a structure [1/s], ascending.
VectorXd frequencies(const MatrixXd& mass, const MatrixXd& stiffness) {
  const Eigen::GeneralizedSelfAdjointEigenSolver<MatrixXd> solver(stiffness, mass, Eigen::EigenvaluesOnly);
  return solver.eigenvalues().cwiseMax(0).cwiseSqrt();
}

TEST(SolidBlock, HasItsWeightAndRisesAsARigidBody) {
  const auto made = reduce_block(half_sleeper(), sleeper_ports(), 9.81, 0);
  const double mass = density * length / 2 * width * height;
  EXPECT_NEAR(made.load.squaredNorm(), 9.81 * 9.81 * mass, 1e-6 * 9.81 * 9.81 * mass);
  // Coordinates of a motion that lifts it by 1 m: all its weight's direction.
  const VectorXd lifted = -made.load / 9.81;
  EXPECT_NEAR(lifted.dot(made.stiffness * lifted), 0, 1e-3);
  EXPECT_TRUE((made.ports.transpose() * lifted).isApprox(VectorXd::Ones(3), 1e-9));
}

TEST(SolidBlock, SleeperBendsAsABeamDoesTheFinerTheNearer) {
  const Beam beam(
      {young, width * std::pow(height, 3) / 12, width * height, density, shear_area(), poisson, 0},
      even_nodes(0, length / 2, 16), BeamEnd::guided, BeamEnd::free);
  const auto line = beam.structure(9.81);
  const VectorXd of_beam = frequencies(MatrixXd(line.mass), MatrixXd(line.stiffness));
  auto furthest = [&](double element) {
    SolidBlock sleeper = half_sleeper();
    sleeper.element = element;
    const VectorXd of_solid =
        reduce_block(sleeper, sleeper_ports(), 9.81, 0).stiffness.diagonal().cwiseMax(0).cwiseSqrt();
    double worst = 0;
    for (const Index bend : {1, 2})  // the first two symmetric bending modes, some 130 and 670 Hz
      worst = std::max(worst, (of_solid.array() / of_beam[bend] - 1).abs().minCoeff());
    return worst;
  };
  const double coarse = furthest(0.075), fine = furthest(0.04);
  EXPECT_LT(coarse, 0.02);
  EXPECT_LT(fine, 0.6 * coarse);
}

TEST(SolidBlock, SlabOnSupportsSagsAsABeamThatShears) {
  constexpr double span = 24, depth = 1.6, half = 2, load = 1e5;
  const SolidBlock slab{
      {0, 0, 0}, {span, half, depth}, 0.4, {3.5e10, poisson, 2500}, HexKind::incompatible, true, true};
  const auto made = reduce_block(slab, {{11.7, 12.3, 0, half, true}}, 0, 1e-4);
  const VectorXd port = made.ports.col(0);
  const double sag = load * port.dot(VectorXd(port.array() / made.stiffness.diagonal().array()));
  const double area = half * depth, inertia = half * std::pow(depth, 3) / 12;
  const double shear = 3.5e10 / (2 * (1 + poisson)) * 10 * (1 + poisson) / (12 + 11 * poisson) * area;
  const double expected = load * std::pow(span, 3) / (48 * 3.5e10 * inertia) + load * span / (4 * shear);
  EXPECT_NEAR(sag, expected, 0.02 * expected);  // the load is spread over 0.6 m and presses into its face
  const double first = std::pow(std::numbers::pi / span, 2) * std::sqrt(3.5e10 * inertia / (2500 * area));
  EXPECT_NEAR(std::sqrt(made.stiffness.diagonal().minCoeff()), first, 0.02 * first);  // less for shear
  EXPECT_TRUE(made.damping.isApprox(1e-4 * made.stiffness, 1e-12));
}

TEST(SolidBlock, HalfAndWholeAnswerAlike) {
  SolidBlock whole = half_sleeper();
  whole.low.y() = -length / 2;
  whole.symmetric = false;
  const auto half = reduce_block(half_sleeper(), sleeper_ports(), 9.81, 0);
  std::vector<FacePatch> patches = sleeper_ports();
  for (const FacePatch& p : sleeper_ports())
    patches.push_back({p.x_low, p.x_high, -p.y_high, -p.y_low, p.upper});
  const auto both = reduce_block(whole, patches, 9.81, 0);
  // On springs of 1e8 N/m at the ports of the base, under 10 kN on each seat.
  auto sink = [](const Structure<MatrixXd>& made) {
    const Index ports = made.ports.cols();
    MatrixXd k = made.stiffness;
    VectorXd f = VectorXd::Zero(k.rows());
    for (Index p = 0; p < ports; ++p)
      if (p % 3 == 2)
        f -= 1e4 * made.ports.col(p);
      else
        k += 1e8 * made.ports.col(p) * made.ports.col(p).transpose();
    // What has neither springs nor load (pitch) is held by a little.
    k.diagonal().array() += 1e-3;
    return VectorXd(made.ports.transpose() * k.ldlt().solve(f));
  };
  const VectorXd one = sink(half), two = sink(both);
  EXPECT_TRUE(two.head(3).isApprox(one, 1e-4)) << one.transpose() << "\n" << two.transpose();
  EXPECT_TRUE(two.tail(3).isApprox(one, 1e-4));
}

TEST(SolidBlock, HalfAndWholeSlabAnswerAlike) {
  const double span = 6, depth = 0.4, half = 1.2, seat = 0.7;
  SolidBlock slab{{0, 0, 0}, {span, half, depth}, 0.3, {3.5e10, poisson, 2500}, HexKind::incompatible, true,
                  true};
  const FacePatch right{2.9, 3.1, seat - 0.1, seat + 0.1, true},
      left{2.9, 3.1, -seat - 0.1, -seat + 0.1, true};
  const auto one = reduce_block(slab, {right}, 0, 0);
  slab.low.y() = -half;
  slab.symmetric = false;
  const auto two = reduce_block(slab, {left, right}, 0, 0);
  // Under the same force on each rail, at rest and in the lowest bending mode.
  auto sag = [](const Structure<MatrixXd>& made) {
    const VectorXd force = made.ports.rowwise().sum();
    return made.ports.col(0).dot(VectorXd(force.array() / made.stiffness.diagonal().array()));
  };
  EXPECT_NEAR(sag(two), sag(one), 1e-4 * sag(one));  // the whole is held across at two nodes only
  EXPECT_NEAR(two.stiffness.diagonal().minCoeff(), one.stiffness.diagonal().minCoeff(),
              1e-3 * one.stiffness.diagonal().minCoeff());
}

}  // namespace
}  // namespace trackbed::fem
