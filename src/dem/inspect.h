// Checks that the state is still sound, and the balances that show it.
#pragma once

#include "dem/model.h"
#include "dem/state.h"
#include "dem/workspace.h"

namespace trackbed {

/// Throws RunError naming the stone, its place and the cause when a number is not finite, a stone is too
/// fast, has left the domain, or overlaps its neighbour too far.
void inspect(const Model& model, const State& state, const Workspace& work);

/// Where the energy is and where it went, at time t [J].
struct EnergyBalance {
  double kinetic = 0;        // stones and bodies
  double potential = 0;      // in gravity, above z = 0
  double strain = 0;         // in normal, shear and rolling springs
  double friction_loss = 0;  // all losses since the start, positive
  double rolling_loss = 0;
  double dashpot_loss = 0;
  double damping_loss = 0;
  double boundary_work = 0;  // that moved walls did on the stones since the start
  double applied_work = 0;   // that applied forces did on bodies since the start
  template <class A>
  void archive(A& a) {
    a(kinetic, potential, strain, friction_loss, rolling_loss, dashpot_loss, damping_loss, boundary_work,
      applied_work);
  }
  EnergyBalance& operator+=(const EnergyBalance& other);

  /// Constant in time when the balance closes.
  double total() const {
    return kinetic + potential + strain + friction_loss + rolling_loss + dashpot_loss + damping_loss -
           boundary_work - applied_work;
  }
};
EnergyBalance energy_of(const Model& model, const State& state);

/// Sum over stones of the unbalanced force over the sum of all forces on them (PFC's "average ratio"): below
/// 1e-3 the bed is at rest. Zero without forces.
double unbalanced_ratio(const Model& model, const State& state);

}  // namespace trackbed
