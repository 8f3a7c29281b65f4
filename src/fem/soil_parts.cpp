#include "fem/soil_parts.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace trackbed::fem {
namespace {

/// Integral of the hat function of height 1 at 0 and feet at -h and h, from minus infinity to y.
double hat_integral(double y, double h) {
  const double t = std::clamp(y / h, -1.0, 1.0);
  return h * (t <= 0 ? 0.5 * (1 + t) * (1 + t) : 1 - 0.5 * (1 - t) * (1 - t));
}

}  // namespace

MatrixXd patch_shares(const Soil& soil, int patches) {
  const double h = soil.input.element_size;
  const int sides = soil.input.whole_width ? 2 : 1;
  const double low = soil.input.whole_width ? -h * (soil.nodes_across - 1) / 2.0 : 0;
  const double length = h * (soil.nodes_across - 1) / (sides * patches);
  MatrixXd shares(soil.nodes_per_footing(), sides * patches);
  for (int p = 0; p < sides * patches; ++p)
    for (int row = 0; row < soil.nodes_across; ++row) {
      // Hats at the edges of the footing have one foot only: patches end there.
      const double y = low + row * h, a = low + p * length, b = a + length;
      const double across = (hat_integral(b - y, h) - hat_integral(a - y, h)) / length;
      for (int node = 0; node < soil.nodes_along; ++node) {
        const bool edge = node == 0 || node + 1 == soil.nodes_along;
        shares(row * soil.nodes_along + node, p) = across * (edge ? 0.5 : 1.0) / (soil.nodes_along - 1);
      }
    }
  return shares;
}

std::unique_ptr<ModalPart> make_reduced_part(const Soil& soil, const ReducedSoil& reduced, int patches) {
  const Index n = reduced.stiffness.size(), nodes = soil.nodes_per_footing();
  const MatrixXd shares = patch_shares(soil, patches);
  MatrixXd ports(n, soil.footings() * shares.cols());
  for (Index f = 0; f < soil.footings(); ++f)
    ports.middleCols(f * shares.cols(), shares.cols()) =
        reduced.nodes.middleRows(f * nodes, nodes).transpose() * shares;
  const VectorXd own = soil.input.mass_damping + soil.input.stiffness_damping * reduced.stiffness.array();
  MatrixXd dashpots = reduced.damping;
  dashpots.diagonal() -= own;
  auto columns = std::make_shared<const MatrixXd>(few_columns(std::move(dashpots), 1e-8));
  const VectorXd zero = VectorXd::Zero(n);
  return std::make_unique<ModalPart>(Structure<ModalMatrix>{{VectorXd::Ones(n), 0, nullptr},
                                                            {own, 1, std::move(columns)},
                                                            {reduced.stiffness, 0, nullptr},
                                                            zero,
                                                            std::move(ports),
                                                            true});
}

ExplicitPart::ExplicitPart(const Soil& soil, std::unique_ptr<ModalPart> for_rest, int patches)
    : soil_(soil), for_rest_(std::move(for_rest)), shares_(patch_shares(soil, patches)) {
  force_ = VectorXd::Zero(for_rest_->ports());
}

VectorXd ExplicitPart::to_nodes(const VectorXd& forces) const {
  const Index p = shares_.cols();
  return (shares_ * forces.reshaped(p, forces.size() / p)).reshaped();
}

VectorXd ExplicitPart::to_patches(const VectorXd& nodes) const {
  const Index n = shares_.rows();
  return (shares_.transpose() * nodes.reshaped(n, nodes.size() / n)).reshaped();
}

void ExplicitPart::move_by(const TimeScheme& scheme) {
  soil_.start(to_nodes(force_), scheme.step);
  moves_ = true;
}

void ExplicitPart::predict(Eigen::Ref<VectorXd> displacement, Eigen::Ref<VectorXd> velocity) {
  if (!moves_) return for_rest_->predict(displacement, velocity);
  soil_.step(to_nodes(force_));
  state(displacement, velocity);
}

void ExplicitPart::respond(const Eigen::Ref<const VectorXd>& force, Eigen::Ref<VectorXd> displacement) const {
  if (moves_)
    displacement.setZero();
  else
    for_rest_->respond(force, displacement);
}

VectorXd ExplicitPart::compliance() const {
  return moves_ ? VectorXd::Zero(ports()) : for_rest_->compliance();
}

void ExplicitPart::advance(const Eigen::Ref<const VectorXd>& force) {
  force_ = force;
  if (!moves_) for_rest_->advance(force);
}

void ExplicitPart::state(Eigen::Ref<VectorXd> displacement, Eigen::Ref<VectorXd> velocity) const {
  if (!moves_) return for_rest_->state(displacement, velocity);
  displacement = to_patches(soil_.displacement());
  velocity = to_patches(soil_.velocity());
}

}  // namespace trackbed::fem
