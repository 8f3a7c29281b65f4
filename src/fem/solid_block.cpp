#include "fem/solid_block.h"

#include <Eigen/SparseCholesky>
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "base/error.h"
#include "fem/assembly.h"
#include "fem/ritz.h"

namespace trackbed::fem {
namespace {

constexpr int krylov = 3;

/// Equal steps between two ends.
struct Steps {
  double low, length;
  int parts;

  Steps(double from, double to, double longest)
      : low(from),
        length((to - from) / std::ceil((to - from) / longest - 1e-9)),
        parts(static_cast<int>(std::lround((to - from) / length))) {}
  int nodes() const { return parts + 1; }

  /// Weights of the nodes in the mean over [a, b] of what is linear between them.
  VectorXd mean(double a, double b) const {
    VectorXd weights = VectorXd::Zero(nodes());
    for (int e = 0; e < parts; ++e) {
      const double start = low + e * length;
      const double from = std::max(a, start), to = std::min(b, start + length);
      if (to <= from) continue;
      const double share = (to - from) / (b - a), middle = (0.5 * (from + to) - start) / length;
      weights[e] += share * (1 - middle);
      weights[e + 1] += share * middle;
    }
    return weights;
  }
};

class BlockModel {
 public:
  explicit BlockModel(const SolidBlock& b)
      : block_(b),
        x_(b.low.x(), b.high.x(), b.element),
        y_(b.low.y(), b.high.y(), b.element),
        z_(b.low.z(), b.high.z(), b.element),
        mesh_(make_block(b.low, b.high, x_.parts, y_.parts, z_.parts)),
        free_(static_cast<int>(mesh_.nodes.size())) {
    hold();
    stiffness = assemble_stiffness(mesh_, {b.solid}, b.kind, free_);
    mass = assemble_mass(mesh_, {b.solid}, free_);
  }

  SparseMatrix stiffness, mass;

  Index size() const { return free_.size(); }

  MatrixXd ports(const std::vector<FacePatch>& patches) const {
    MatrixXd all = MatrixXd::Zero(size(), static_cast<Index>(patches.size()));
    for (std::size_t p = 0; p < patches.size(); ++p) {
      const VectorXd along = x_.mean(patches[p].x_low, patches[p].x_high);
      const VectorXd across = y_.mean(patches[p].y_low, patches[p].y_high);
      const int k = patches[p].upper ? z_.parts : 0;
      for (int i = 0; i < x_.nodes(); ++i)
        for (int j = 0; j < y_.nodes(); ++j)
          if (const int row = free_(node(i, j, k), 2); row >= 0)
            all(row, static_cast<Index>(p)) = along[i] * across[j];
    }
    return all;
  }

  /// It moves as a rigid body, up and about the axes that lie flat.
  MatrixXd rigid() const {
    MatrixXd all = MatrixXd::Zero(size(), 3);
    const Vec3 middle = 0.5 * (block_.low + block_.high);
    for (int n = 0; n < free_.nodes(); ++n) {
      const Vec3 r = mesh_.nodes[static_cast<std::size_t>(n)] - middle;
      const std::array<Vec3, 3> motions{Vec3(0, 0, 1), Vec3(0, -r.z(), r.y()), Vec3(-r.z(), 0, r.x())};
      for (int axis = 0; axis < 3; ++axis)
        if (const int row = free_(n, axis); row >= 0)
          for (int m = 0; m < 3; ++m) all(row, m) = motions[static_cast<std::size_t>(m)][axis];
    }
    return all;
  }

 private:
  int node(int i, int j, int k) const { return (i * z_.nodes() + k) * y_.nodes() + j; }

  void hold() {
    for (int i = 0; i < x_.nodes(); ++i)
      for (int k = 0; k < z_.nodes(); ++k)
        if (block_.symmetric) free_.hold(node(i, 0, k), 1);
    if (block_.on_supports) {
      for (int j = 0; j < y_.nodes(); ++j)
        for (int i : {0, x_.parts}) free_.hold(node(i, j, 0), 2);
      for (int j = 0; j < y_.nodes(); ++j) free_.hold(node(0, j, 0), 0);
      for (int i : {0, x_.parts})
        if (!block_.symmetric)
          free_.hold(node(i, y_.parts / 2, 0), 1);  // it neither drifts nor turns about z
    }
    free_.number();
  }

  SolidBlock block_;
  Steps x_, y_, z_;
  HexMesh mesh_;
  Freedoms free_;
};

}  // namespace

Structure<MatrixXd> reduce_block(const SolidBlock& block, const std::vector<FacePatch>& patches,
                                 double gravity, double damping) {
  if (!((block.high - block.low).minCoeff() > 0) || !(block.element > 0))
    throw InputError("a block of hexahedra needs extent in all directions");
  const BlockModel model(block);
  const MatrixXd ports = model.ports(patches), rigid = model.rigid();
  // A block that floats has no static shape: half of the lowest frequency that matters holds it.
  const double shift = block.on_supports ? 0 : std::pow(2 * std::numbers::pi * 50, 2);
  const Eigen::SimplicialLLT<SparseMatrix> factor(SparseMatrix(model.stiffness + shift * model.mass));
  if (factor.info() != Eigen::Success) throw InputError("a block of hexahedra is not held");
  MassBasis shapes([&](const VectorXd& v) -> VectorXd { return model.mass * v; }, rigid.rows(),
                   3 + ports.cols() * (1 + krylov));
  auto add = [&](const MatrixXd& columns) {
    for (Index c = 0; c < columns.cols(); ++c) shapes.add(columns.col(c));
  };
  if (!block.on_supports) add(rigid);
  MatrixXd columns = factor.solve(ports);
  for (int level = 0; level <= krylov; ++level) {
    add(columns);
    columns = factor.solve(MatrixXd(model.mass * columns));
  }
  const MatrixXd v = shapes.columns();
  const auto [stiffness, of_shapes] =
      ritz_modes(v.transpose() * (model.mass * v).eval(), v.transpose() * (model.stiffness * v).eval());
  const MatrixXd modes = v * of_shapes;
  const Index n = modes.cols();
  const VectorXd weight = -gravity * (model.mass * rigid.col(0));
  return {MatrixXd::Identity(n, n),  damping * MatrixXd(stiffness.asDiagonal()),
          stiffness.asDiagonal(),    modes.transpose() * weight,
          modes.transpose() * ports, block.on_supports};
}

}  // namespace trackbed::fem
