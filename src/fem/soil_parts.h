// The soil of an embankment as a part of a track: ports are the mean sinkings of the patches under each
// sleeper, and forces spread evenly over them.
#pragma once

#include <memory>

#include "fem/explicit_soil.h"
#include "fem/implicit_part.h"
#include "fem/reduced_soil.h"

namespace trackbed::fem {

/// Shares of a footing's nodes in its patches, strips of equal length across the track: nodes x patches, the
/// columns add up to 1. `patches`: of half a sleeper.
MatrixXd patch_shares(const Soil& soil, int patches);

/// The reduced soil, implicit. Its own weight has no part: displacements count from its rest.
std::unique_ptr<ModalPart> make_reduced_part(const Soil& soil, const ReducedSoil& reduced, int patches);

/// The soil in full order, by central differences with the step of the others. Rest is found with the reduced
/// form; from there it starts at its own rest under the same forces.
class ExplicitPart : public Part {
 public:
  ExplicitPart(const Soil& soil, std::unique_ptr<ModalPart> for_rest, int patches);

  Index ports() const override { return for_rest_->ports(); }
  /// Throws RunError for a step that is too long.
  void move_by(const TimeScheme& scheme) override;
  void rest_by(double shift) override { for_rest_->rest_by(shift); }
  void predict(Eigen::Ref<VectorXd> displacement, Eigen::Ref<VectorXd> velocity) override;
  void respond(const Eigen::Ref<const VectorXd>& force, Eigen::Ref<VectorXd> displacement) const override;
  VectorXd compliance() const override;
  void advance(const Eigen::Ref<const VectorXd>& force) override;
  void state(Eigen::Ref<VectorXd> displacement, Eigen::Ref<VectorXd> velocity) const override;
  /// Not kept: the run's balance leaves it out.
  PartEnergy energy() const override { return {}; }
  bool uses_threads() const override { return true; }

 private:
  VectorXd to_nodes(const VectorXd& forces) const;
  VectorXd to_patches(const VectorXd& nodes) const;

  ExplicitSoil soil_;
  std::unique_ptr<ModalPart> for_rest_;
  MatrixXd shares_;
  VectorXd force_;  // at ports, at the time of the soil's displacement
  bool moves_ = false;
};

}  // namespace trackbed::fem
