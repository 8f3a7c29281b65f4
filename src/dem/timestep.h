// The stable time step; docs/numerics.md, after PFC: every degree of freedom on its own with the stiffness of
// all its contacts, times a safety factor, and a limit on how far anything travels in a step.
#pragma once

#include <limits>

#include "dem/model.h"
#include "dem/state.h"
#include "dem/workspace.h"

namespace trackbed {

/// Diagonal stiffness of one body: translation in world axes [N/m], rotation about its principal axes [N
/// m/rad]; and the same of its dashpots [N s/m], [N m s/rad].
struct DiagonalStiffness {
  Vec3 shift = Vec3::Zero();
  Vec3 turn = Vec3::Zero();
  Vec3 viscous_shift = Vec3::Zero();
  Vec3 viscous_turn = Vec3::Zero();
};

/// Of stone `clump`, from its touching contacts.
DiagonalStiffness stiffness_of(const Model& model, const State& state, const Workspace& work, int clump);

/// Of a wall or body, from its touching contacts.
DiagonalStiffness stiffness_of_wall(const Model& model, const State& state, const Workspace& work, int wall);

/// What limits the step.
struct StableStep {
  double dt = std::numeric_limits<double>::infinity();  // [s]
  int clump = -1;                                       // the stone that limits it; -1: a body
  bool is_kinematic = false;                            // by its motion rather than its stiffness
  int steps = 0;  // for which it may be kept: contacts hardly change meanwhile
};

struct StepPlan {
  double dt;  // [s]
  int steps;  // after which to plan again
};

/// safety x sqrt(m/K) over all degrees of freedom, each stone with at least one contact of the stiffest kind
/// it can make at its farthest point; and the kinematic limit of the fastest.
StableStep stable_step(const Model& model, const State& state, const Workspace& work);

/// The steps to take next, by the rule: stable, not grown too fast, or the user's. Where a share of the
/// stones is asked for (Conditions::scaled_share), differential density scaling comes first: it raises the
/// inertia, not the weight, of stones whose own stable step is shorter than that of this share of all stones,
/// until it is that. For the way to rest only: time and speeds mean nothing while it lasts. Throws RunError
/// when the user's step is above the stable one.
StepPlan plan_steps(const Model& model, State& state, const Workspace& work);

}  // namespace trackbed
