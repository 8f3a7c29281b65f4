// A part: a linear structure (rails, sleepers, soil, bridge, vehicle) that steps through time on its own.
// What joins parts is not linear (fasteners, contacts) and acts through their ports: see coupled_system.h.
#pragma once

#include <Eigen/Core>

namespace trackbed::fem {

using Eigen::Index;
using Eigen::VectorXd;

/// The step of all parts that are implicit: the alpha method of Hilber, Hughes & Taylor (1977),
/// M a1 + (1 + alpha) (C v1 + K u1) - alpha (C v0 + K u0) = (1 + alpha) F1 - alpha F0,
/// with Newmark's u1 = u0 + dt v0 + dt^2 ((1/2 - beta) a0 + beta a1), v1 = v0 + dt ((1 - gamma) a0 + gamma
/// a1). alpha = 0 is Newmark's rule of constant mean acceleration, which keeps energy; down to alpha = -1/3,
/// which damps motion too fast for the step.
struct TimeScheme {
  double step = 1e-3;  // dt [s]
  double alpha = 0;    // -1/3 .. 0

  double beta() const { return (1 - alpha) * (1 - alpha) / 4; }
  double gamma() const { return (1 - 2 * alpha) / 2; }
  /// Change of v1 that comes with a change of u1 [1/s].
  double velocity_per_displacement() const { return gamma() / (beta() * step); }
};

/// Energies of a part [J]; those lost are sums since the start of motion.
struct PartEnergy {
  double kinetic = 0, elastic = 0;  // elastic: 1/2 u K u less the work of constant loads
  double damped = 0;                // by the matrix C
  double numerical = 0;             // by the time scheme itself (alpha < 0)
};

/// Ports are coordinates through which forces act on a part: displacements [m] or rotations [rad], upwards
/// positive; forces [N] or moments [N m] go with them. Within a step a part answers to forces at its ports by
///
///   u = u_predicted + G f,   v = v_predicted + velocity_per_displacement G f
///
/// with a constant compliance G, symmetric and positive (or zero: a part that steps explicitly).
class Part {
 public:
  virtual ~Part() = default;
  virtual Index ports() const = 0;

  /// From now on steps are steps in time by this scheme.
  virtual void move_by(const TimeScheme& scheme) = 0;
  /// From now on steps look for rest: K u + shift M (u - u_before) = F. The shift [1/s^2] holds parts that
  /// would float; it has no part in the result once steps change nothing. A part that is held by itself may
  /// ignore it.
  virtual void rest_by(double shift) = 0;

  /// What ports would do by the end of the step without coupling forces.
  virtual void predict(Eigen::Ref<VectorXd> displacement, Eigen::Ref<VectorXd> velocity) = 0;
  /// displacement = G force.
  virtual void respond(const Eigen::Ref<const VectorXd>& force, Eigen::Ref<VectorXd> displacement) const = 0;
  /// The diagonal of G.
  virtual VectorXd compliance() const = 0;
  /// Goes to the end of the step under these forces.
  virtual void advance(const Eigen::Ref<const VectorXd>& force) = 0;

  /// Ports as they are, in place and on the move.
  virtual void state(Eigen::Ref<VectorXd> displacement, Eigen::Ref<VectorXd> velocity) const = 0;
  virtual PartEnergy energy() const = 0;

  /// Does it share its own steps among threads? Others step side by side.
  virtual bool uses_threads() const { return false; }
};

}  // namespace trackbed::fem
