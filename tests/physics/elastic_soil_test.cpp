// The soil against formulas: columns, waves, a loaded circle, symmetry.
#include <gtest/gtest.h>

#include <cmath>

#include "fem/explicit_soil.h"
#include "fem/reduced_soil.h"
#include "fem/sparse_cholesky.h"
#include "scenes/strip_of_soil.h"

namespace trackbed::fem {
namespace {

/// A column of one material, 3 m high, whose sides only slide; the footing is its whole top.
SoilInput column() {
  SoilInput in;
  in.subgrade = in.ballast;
  in.length = in.half_width = in.crest = in.sleeper_width = in.sleeper_half_length = 0.225;
  in.ballast_depth = 0.3;
  in.subgrade_depth = 2.7;
  in.start = in.end = in.side = Support::roller;
  in.sleepers = 1;
  in.first_sleeper = 0.1125;
  return in;
}
constexpr double height = 3;

/// Forces of a uniform pressure of 1 Pa downwards.
Eigen::VectorXd pressure(const Soil& soil) {
  return -soil.area;
}

TEST(SoilColumn, SettlesUnderItsWeight) {
  const Soil soil = make_soil(column());
  const HexMesh mesh = extrude(soil.section, 0, soil.input.element_size, soil.planes);
  Freedoms free(soil.nodes());
  for (int p = 0; p < soil.planes; ++p)
    for (int s = 0; s < soil.section_size(); ++s)
      for (int axis = 0; axis < 3; ++axis)
        if (soil.is_held(p, s, axis)) free.hold(p * soil.section_size() + s, axis);
  Eigen::VectorXd weight = Eigen::VectorXd::Zero(free.number());
  const Eigen::VectorXd masses = lumped_node_masses(mesh, soil.materials);
  for (int n = 0; n < free.nodes(); ++n)
    if (free(n, 2) >= 0) weight[free(n, 2)] = -9.81 * masses[n];
  const SparseMatrix k = assemble_stiffness(mesh, soil.materials, soil.input.element, free);
  const Eigen::VectorXd u = to_nodes(SparseCholesky(k, free).solve(weight), free);
  const Elastic& solid = soil.input.ballast;
  const double settlement = solid.density * 9.81 * height * height / (2 * solid.constrained_modulus());
  const double top = u[3 * soil.node(0, 1, 1) + 2];
  EXPECT_NEAR(top, -settlement, 1e-9 * settlement);
  // The reduced soil has no column for weight; what it has comes near.
  const ReducedSoil r = reduce(soil);
  const Eigen::VectorXd reduced = r.nodes * r.gravity.cwiseQuotient(r.stiffness);
  EXPECT_NEAR(reduced[5], -settlement, 1e-3 * settlement);
}

TEST(SoilColumn, FirstFrequencyIsAQuarterOfAWave) {
  const Soil soil = make_soil(column());
  const double frequency = std::sqrt(reduce(soil).stiffness[0]) / (2 * M_PI);
  EXPECT_NEAR(frequency, soil.input.ballast.pressure_wave_speed() / (4 * height), 1e-3 * frequency);
}

TEST(SoilColumn, StepLoadSwingsBetweenNothingAndTwiceRest) {
  const Soil soil = make_soil(column());
  const Elastic& solid = soil.input.ballast;
  ExplicitSoil moving(soil);
  const double dt = 0.5 * stable_time_step(soil), period = 4 * height / solid.pressure_wave_speed();
  moving.start(Eigen::VectorXd::Zero(soil.area.size()), dt);
  double greatest = 0, at = 0;
  const int steps = static_cast<int>(period / dt);
  for (int i = 0; i < steps; ++i) {
    moving.step(pressure(soil));
    if (-moving.displacement()[5] > greatest) {
      greatest = -moving.displacement()[5];
      at = (i + 1) * dt;
    }
  }
  EXPECT_NEAR(greatest, 2 * height / solid.constrained_modulus(), 0.02 * greatest);
  EXPECT_NEAR(at, period / 2, 0.02 * period);
  EXPECT_LT(-moving.displacement()[5], 0.02 * greatest);
}

/// Velocity of the top over time, pressed by a smooth pulse of 6 ms; its middle is at 3 ms.
Eigen::VectorXd pulse(const Soil& soil, double dt, int steps) {
  ExplicitSoil moving(soil);
  moving.start(Eigen::VectorXd::Zero(soil.area.size()), dt);
  Eigen::VectorXd v(steps);
  for (int i = 0; i < steps; ++i) {
    const double t = i * dt, p = t < 6e-3 ? std::pow(std::sin(M_PI * t / 6e-3), 2) : 0;
    moving.step(p * pressure(soil));
    v[i] = -moving.velocity()[5];
  }
  return v;
}

// A pulse runs down and comes back from a stiff base turned over, and from dashpots not at all.
TEST(SoilColumn, DashpotsSwallowWhatAStiffBaseThrowsBack) {
  SoilInput in = column();
  in.ballast_depth = 0.6;
  in.subgrade_depth = 2.4;
  const Elastic& solid = in.ballast;
  const double dt = 0.1e-3, there_and_back = 2 * height / solid.pressure_wave_speed();
  const int steps = static_cast<int>(1.4 * there_and_back / dt),
            echo = static_cast<int>(0.7 * there_and_back / dt);
  const Eigen::VectorXd stiff = pulse(make_soil(in), dt, steps);
  in.base = Support::absorbing;
  const Eigen::VectorXd soft = pulse(make_soil(in), dt, steps);

  Eigen::Index first, second;
  const double going = stiff.head(echo).maxCoeff(&first), coming = stiff.tail(steps - echo).minCoeff(&second);
  EXPECT_NEAR(going, 1 / (solid.density * solid.pressure_wave_speed()), 0.02 * going);
  EXPECT_NEAR(coming, -2 * going, 0.05 * going);
  EXPECT_NEAR((static_cast<double>(second + echo - first)) * dt, there_and_back, 0.01 * there_and_back);
  EXPECT_LT(soft.tail(steps - echo).cwiseAbs().maxCoeff(), 0.01 * going);
}

/// Settlement of the middle of a circle of radius 1 m under 1 Pa on a block of `size` radii each way, a
/// quarter of it; elements grow outwards from 1/8 m.
double circle_on_block(const Elastic& solid, double size) {
  constexpr int inner = 8, outer = 10, n = inner + outer;
  double growth = 1.0;  // of elements: such that they reach `size`
  for (double low = 1, high = 4; high - low > 1e-12;) {
    growth = (low + high) / 2;
    double reach = 1, step = 1.0 / inner;
    for (int i = 0; i < outer; ++i) reach += step *= growth;
    (reach < size ? low : high) = growth;
  }
  std::vector<double> place{0};
  for (int i = 0; i < n; ++i)
    place.push_back(place.back() + 1.0 / inner * (i < inner ? 1 : std::pow(growth, i - inner + 1)));
  HexMesh mesh = make_block(Vec3::Zero(), Vec3::Constant(n), n, n, n);
  for (Vec3& x : mesh.nodes)
    x = Vec3(place[static_cast<std::size_t>(std::lround(x.x()))],
             place[static_cast<std::size_t>(std::lround(x.y()))],
             -place[static_cast<std::size_t>(n - std::lround(x.z()))]);
  Freedoms free(static_cast<int>(mesh.nodes.size()));
  for (int i = 0; i < free.nodes(); ++i) {
    const Vec3& x = mesh.nodes[static_cast<std::size_t>(i)];
    if (x.x() == 0) free.hold(i, 0);
    if (x.y() == 0) free.hold(i, 1);
    if (std::max({x.x(), x.y(), -x.z()}) > place.back() - 1e-9) free.hold_all(i);
  }
  Eigen::VectorXd force = Eigen::VectorXd::Zero(free.number());
  // Uniform pressure inside the circle, spread by the elements' shape functions: a sum over small squares.
  constexpr int fine = 20;
  for (int i = 0; i < inner * fine; ++i)
    for (int j = 0; j < inner * fine; ++j) {
      const double x = (i + 0.5) / fine, y = (j + 0.5) / fine;  // in elements
      if (std::hypot(x, y) > inner) continue;
      const int a = i / fine, b = j / fine;
      const double f = -1.0 / (inner * fine) / (inner * fine);
      for (int di = 0; di <= 1; ++di)
        for (int dj = 0; dj <= 1; ++dj) {
          // Nodes of a block: y first, then z, then x.
          const int node = (a + di) * (n + 1) * (n + 1) + n * (n + 1) + (b + dj);
          force[free(node, 2)] += f * (di ? x - a : 1 + a - x) * (dj ? y - b : 1 + b - y);
        }
    }
  const SparseMatrix k = assemble_stiffness(mesh, {solid}, HexKind::b_bar, free);
  return -to_nodes(SparseCholesky(k, free).solve(force), free)[3 * (n * (n + 1)) + 2];
}

TEST(Halfspace, CircleSettlesAsBoussinesqSaid) {
  const Elastic solid{1e6, 0.3, 1};
  const double wanted = 2 * (1 - 0.09) / 1e6;
  // What a block of finite size lacks falls with one over its size: 10, 20 and 40 radii.
  const double a = circle_on_block(solid, 10), b = circle_on_block(solid, 20), c = circle_on_block(solid, 40);
  EXPECT_LT(a, b);
  EXPECT_LT(b, c);
  EXPECT_NEAR((c - b) / (b - a), 0.5, 0.06);
  EXPECT_NEAR(2 * c - b, wanted, 0.015 * wanted);
}

TEST(Symmetry, HalfMovesLikeTheWhole) {
  SoilInput in = strip_of_soil();
  in.side = Support::absorbing;
  const Soil half = make_soil(in);
  in.whole_width = true;
  const Soil whole = make_soil(in);
  const int along = half.nodes_along, each = half.nodes_per_footing(), rows = half.nodes_across;
  Eigen::VectorXd f(5 * each), f_whole(5 * whole.nodes_per_footing());
  auto entry = [&](int footing, int row, int a) {
    return footing * whole.nodes_per_footing() + row * along + a;
  };
  f_whole.setZero();
  for (int i = 0; i < f.size(); ++i) {
    const int footing = i / each, row = i % each / along, a = i % along;
    f[i] = -1000 - 100 * ((7 * i) % 13);
    f_whole[entry(footing, rows - 1 + row, a)] += f[i];
    f_whole[entry(footing, rows - 1 - row, a)] += f[i];
  }
  ExplicitSoil one(half), both(whole);
  const double dt = 0.9 * stable_time_step(half);
  one.start(f, dt);
  both.start(f_whole, dt);
  for (int step = 0; step < 300; ++step) {
    one.step(0.5 * f);
    both.step(0.5 * f_whole);
  }
  const double size = one.displacement().cwiseAbs().maxCoeff();
  for (int i = 0; i < f.size(); ++i)
    for (int side : {-1, 1})
      EXPECT_NEAR(both.displacement()[entry(i / each, rows - 1 + side * (i % each / along), i % along)],
                  one.displacement()[i], 1e-10 * size);
  // The same at rest with few unknowns: the whole's are twice as many shapes.
  const ReducedSoil small = reduce(half, {0, 0, 18}), large = reduce(whole, {0, 0, 18});
  const Eigen::VectorXd u = small.nodes * (small.nodes.transpose() * f).cwiseQuotient(small.stiffness);
  const Eigen::VectorXd v = large.nodes * (large.nodes.transpose() * f_whole).cwiseQuotient(large.stiffness);
  EXPECT_NEAR(v[entry(2, rows + 1, 1)], u[2 * each + 2 * along + 1], 1e-9 * u.cwiseAbs().maxCoeff());
}

}  // namespace
}  // namespace trackbed::fem
