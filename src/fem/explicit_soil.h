// The soil in full order: central differences, matrix-free. See soil.h for ports and signs.
#pragma once

#include <memory>

#include "fem/soil.h"

namespace trackbed::fem {

/// The longest stable step of central differences without a margin [s]: 2/w of the free elements' greatest
/// frequency, a bound from below, shortened for stiffness damping. That of the soil alone: springs of a
/// contact on its nodes shorten it further.
double stable_time_step(const Soil&);

/// u(n+1) from u(n), u(n-1) and the forces at n:
///     M (u(n+1) - 2 u(n) + u(n-1))/dt^2 + C (u(n+1) - u(n-1))/(2 dt) + K u(n) = f(n)
/// with lumped mass and diagonal C (dashpots, mass damping); stiffness damping is taken with the velocity of
/// the last half step. Displacements count from the soil's rest under its own weight. Same bits for any
/// number of threads (of OpenMP).
class ExplicitSoil {
 public:
  explicit ExplicitSoil(const Soil&);
  ~ExplicitSoil();

  /// At rest under constant vertical forces on footing nodes [N] (conjugate gradients, to a residual of 1e-9
  /// of the forces); all further steps last dt [s]. Throws RunError for dt beyond stable_time_step, or when
  /// nothing holds the soil.
  void start(const Eigen::VectorXd& forces, double dt);

  /// One step: forces at the time of displacement() [N].
  void step(const Eigen::VectorXd& forces);

  const Eigen::VectorXd& displacement() const;  // of footing nodes, u(n) [m]
  const Eigen::VectorXd& velocity() const;      // of footing nodes, (u(n) - u(n-1))/dt [m/s]

 private:
  struct Parts;
  std::unique_ptr<Parts> parts_;
};

}  // namespace trackbed::fem
