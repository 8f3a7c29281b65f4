// The soil with few unknowns against the soil in full, under axles that move over the footings.
#include <gtest/gtest.h>

#include <cmath>

#include "fem/explicit_soil.h"
#include "fem/reduced_soil.h"
#include "fem/sparse_cholesky.h"

namespace trackbed::fem {
namespace {

/// Twelve bays; at 0.15 m narrower and with wider sleepers, to suit the elements and to be quick.
SoilInput twelve_bays(double element_size, Support ends) {
  SoilInput in;
  in.element_size = element_size;
  in.length = 7.2;
  in.sleepers = 12;
  in.start = in.end = ends;
  if (element_size > 0.1) {
    in.subgrade_depth = 0.9;
    in.half_width = in.crest = 1.2;
    in.first_sleeper = 0.3;
    in.sleeper_width = 0.3;
  }
  return in;
}

SoilInput twelve_bays_to_a_free_end() {
  SoilInput in = twelve_bays(0.15, Support::roller);
  in.end = Support::free;
  return in;
}

/// On one sleeper, after 0.15 s.
struct Blow {
  double force = 0, duration = 0.01;
  int footing = 6;
};

/// Two axles 2.5 m apart at 40 m/s, 38 kN a half sleeper at most, and a blow. The pressure grows outwards by
/// a power that is in no basis.
Eigen::VectorXd passing(const Soil& soil, double time, const Blow& blow) {
  const int each = soil.nodes_per_footing();
  Eigen::VectorXd shape(each);
  for (int row = 0; row < soil.nodes_across; ++row)
    for (int a = 0; a < soil.nodes_along; ++a) {
      const double y = static_cast<double>(row) / (soil.nodes_across - 1);
      const int n = row * soil.nodes_along + a;
      shape[n] = soil.area[n] * (1 + 0.6 * y * y * y - 0.3 * (a == 0));
    }
  shape /= shape.sum();
  Eigen::VectorXd f(soil.footings() * each);
  for (int s = 0; s < soil.footings(); ++s) {
    double force = 0;
    for (double axle : {-2.5, -5.0}) {  // before the first footing at first
      const double d = (soil.x_of(s) - (40 * time + axle)) / 0.6;
      force += 38e3 * std::exp(-d * d / 2);
    }
    if (s == blow.footing && time > 0.15 && time < 0.15 + blow.duration)
      force += blow.force * std::pow(std::sin(M_PI * (time - 0.15) / blow.duration), 2);
    f.segment(s * each, each) = -force * shape;
  }
  return f;
}

constexpr double duration = 0.3;

/// Mean displacement of each footing (rows) at each step (columns).
using History = Eigen::MatrixXd;

void record(const Soil& soil, const Eigen::VectorXd& u, Eigen::Ref<Eigen::VectorXd> means) {
  const int each = soil.nodes_per_footing();
  for (int s = 0; s < soil.footings(); ++s)
    means[s] = soil.area.dot(u.segment(s * each, each)) / soil.area.sum();
}

/// Newmark's rule (1/4, 1/2) of the full matrices, lumped mass, from rest.
History full_order(const Soil& soil, double dt, const Blow& blow = {}) {
  const int steps = static_cast<int>(std::lround(duration / dt));
  Freedoms free(soil.nodes());
  for (int p = 0; p < soil.planes; ++p)
    for (int s = 0; s < soil.section_size(); ++s)
      for (int axis = 0; axis < 3; ++axis)
        if (soil.is_held(p, s, axis)) free.hold(p * soil.section_size() + s, axis);
  free.number();
  const HexMesh mesh = extrude(soil.section, 0, soil.input.element_size, soil.planes);
  const SparseMatrix k = assemble_stiffness(mesh, soil.materials, soil.input.element, free);
  const Eigen::VectorXd m = to_freedoms(lumped_node_masses(mesh, soil.materials), free);
  Eigen::VectorXd c(free.size());
  for (int n = 0; n < soil.nodes(); ++n)
    for (int axis = 0; axis < 3; ++axis)
      if (free(n, axis) >= 0)
        c[free(n, axis)] = soil.dashpot(n / soil.section_size(), n % soil.section_size())[axis];
  SparseMatrix effective = k;
  effective.diagonal() += 4 / (dt * dt) * m + 2 / dt * c;
  const SparseCholesky factor(effective, free);
  Eigen::VectorXd u = Eigen::VectorXd::Zero(free.size()), v = u, a = u;
  History history(soil.footings(), steps);
  for (int step = 0; step < steps; ++step) {
    Eigen::VectorXd right =
        m.cwiseProduct(4 / (dt * dt) * u + 4 / dt * v + a) + c.cwiseProduct(2 / dt * u + v);
    const Eigen::VectorXd f = passing(soil, (step + 1) * dt, blow);
    const int each = soil.nodes_per_footing();
    for (int i = 0; i < f.size(); ++i) {
      const int n = soil.node(i / each, i % soil.nodes_along, i % each / soil.nodes_along);
      right[free(n, 2)] += f[i];
    }
    const Eigen::VectorXd next = factor.solve(right);
    const Eigen::VectorXd a1 = 4 / (dt * dt) * (next - u) - 4 / dt * v - a;
    v += dt / 2 * (a + a1);
    a = a1;
    u = next;
    const Eigen::VectorXd all = to_nodes(u, free);
    Eigen::VectorXd footings(f.size());
    for (int i = 0; i < f.size(); ++i)
      footings[i] = all[3 * soil.node(i / each, i % soil.nodes_along, i % each / soil.nodes_along) + 2];
    record(soil, footings, history.col(step));
  }
  return history;
}

History reduced_order(const Soil& soil, const ReducedSoil& r, double dt, const Blow& blow = {}) {
  const int steps = static_cast<int>(std::lround(duration / dt));
  const Eigen::Index n = r.stiffness.size();
  Eigen::MatrixXd effective = 2 / dt * r.damping;
  effective.diagonal() += r.stiffness;
  effective.diagonal().array() += 4 / (dt * dt);
  const Eigen::LLT<Eigen::MatrixXd> factor(effective);
  Eigen::VectorXd q = Eigen::VectorXd::Zero(n), v = q, a = q;
  History history(soil.footings(), steps);
  for (int step = 0; step < steps; ++step) {
    const Eigen::VectorXd right = r.nodes.transpose() * passing(soil, (step + 1) * dt, blow) +
                                  4 / (dt * dt) * q + 4 / dt * v + a + r.damping * (2 / dt * q + v);
    const Eigen::VectorXd next = factor.solve(right);
    const Eigen::VectorXd a1 = 4 / (dt * dt) * (next - q) - 4 / dt * v - a;
    v += dt / 2 * (a + a1);
    a = a1;
    q = next;
    record(soil, r.nodes * q, history.col(step));
  }
  return history;
}

History explicit_order(const Soil& soil, double dt) {
  const int steps = static_cast<int>(std::lround(duration / dt));
  ExplicitSoil moving(soil);
  moving.start(Eigen::VectorXd::Zero(soil.footings() * soil.nodes_per_footing()), dt);
  History history(soil.footings(), steps);
  for (int step = 0; step < steps; ++step) {
    moving.step(passing(soil, step * dt, {}));
    record(soil, moving.displacement(), history.col(step));
  }
  return history;
}

/// Greatest differences from the full model, each over the greatest displacement there is.
struct Difference {
  double worst, peak, rms;  // at any time; of a footing's peaks, over its own; root mean square
};
Difference compare(const History& is, const History& wanted) {
  const History d = is - wanted;
  const Eigen::VectorXd peaks = (-wanted).rowwise().maxCoeff(), found = (-is).rowwise().maxCoeff();
  return {d.cwiseAbs().maxCoeff() / peaks.maxCoeff(),
          ((found - peaks).cwiseAbs().cwiseQuotient(peaks)).maxCoeff(),
          std::sqrt(d.squaredNorm() / wanted.squaredNorm())};
}

// Smooth passing needs few columns, a blow of 10 ms more; static columns alone do not follow it.
void expect_columns_to_converge(double element_size, const std::vector<int>& krylov) {
  const Soil soil = make_soil(twelve_bays(element_size, Support::roller));
  const double dt = 1e-3;
  const History axles = full_order(soil, dt), blow = full_order(soil, dt, {30e3});
  double before = 0.5;
  for (int k : krylov) {
    const ReducedSoil reduced = reduce(soil, {.krylov = k, .window = 18});
    EXPECT_LT(compare(reduced_order(soil, reduced, dt), axles).worst, 1e-3);
    const double error = compare(reduced_order(soil, reduced, dt, {30e3}), blow).peak;
    EXPECT_LT(error, before / 2) << k;
    before = error;
  }
  EXPECT_LT(before, 0.01);
}

TEST(ReducedSoil, FollowsTheFullModelUnderMovingAxlesAndABlow) {
  expect_columns_to_converge(0.15, {0, 1, 3});
}
TEST(ReducedSoil, long_FollowsTheFullModelAt75Millimetres) {
  expect_columns_to_converge(0.075, {0, 3, 4});  // three leave 2 % here, where the ground is deeper too
}

TEST(ReducedSoil, FollowsTheFullModelBesideDashpots) {
  const Soil soil = make_soil(twelve_bays(0.15, Support::absorbing));
  const double dt = 1e-3;
  EXPECT_LT(compare(reduced_order(soil, reduce(soil), dt), full_order(soil, dt)).peak, 0.005);
}

// Beside a bridge sleepers hang and strike; the columns that follow their blows are not needed elsewhere.
TEST(ReducedSoil, MoreColumnsBesideAFreeEndFollowTheBlowsThere) {
  const Soil soil = make_soil(twelve_bays_to_a_free_end());
  const double dt = 0.25e-3;
  const Blow blow{100e3, 0.004, 10};
  const double peak = -full_order(soil, dt, blow).row(blow.footing).minCoeff();
  auto error = [&](int krylov, int at_free_end) {
    const ReducedSoil r = reduce(soil, {krylov, at_free_end, 4.8, 0});
    return std::abs(-reduced_order(soil, r, dt, blow).row(blow.footing).minCoeff() / peak - 1);
  };
  const double more = error(3, 8);
  EXPECT_GT(error(3, 3), 0.01);
  EXPECT_LT(more, 0.002);
  EXPECT_NEAR(more, error(8, 8), 0.001);
}

// Columns about rest follow the stroke of a blow of 2 ms, but not how the soil swings after it: the next
// sleeper that strikes there finds it elsewhere.
TEST(ReducedSoil, ColumnsAboutABlowFollowWhatItLeaves) {
  const Soil soil = make_soil(twelve_bays_to_a_free_end());
  const double dt = 0.2e-3;
  const Blow blow{100e3, 0.002, 10};
  const auto from = std::lround(0.15 / dt), steps = std::lround(3 * blow.duration / dt);
  auto swing = [&](const History& h) { return h.row(blow.footing).segment(from, steps).eval(); };
  const Eigen::RowVectorXd wanted = swing(full_order(soil, dt, blow));
  auto error = [&](double frequency) {
    const History is = reduced_order(soil, reduce(soil, {3, 8, 4.8, frequency}), dt, blow);
    return (swing(is) - wanted).cwiseAbs().maxCoeff() / -wanted.minCoeff();
  };
  EXPECT_GT(error(0), 0.1);
  EXPECT_LT(error(200), 0.03);
}

TEST(ExplicitSoil, FollowsTheImplicitFullModel) {
  const Soil soil = make_soil(twelve_bays(0.15, Support::absorbing));
  const double dt = 0.375e-3;
  EXPECT_LT(compare(explicit_order(soil, dt), full_order(soil, dt)).worst, 1e-3);
}

}  // namespace
}  // namespace trackbed::fem
