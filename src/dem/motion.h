// The motion of stones, walls and bodies over one step.
#pragma once

#include "dem/model.h"
#include "dem/state.h"
#include "dem/workspace.h"

namespace trackbed {

/// Unbalanced force with Cundall's local damping: each component loses `alpha` of itself against the motion.
Vec3 damped(const Vec3& unbalanced, const Vec3& velocity, double alpha);

/// Leapfrog: velocities from t - dt_old/2 to t + dt/2, then positions from t to t + dt.
void move_clumps(const Model& model, State& state, Workspace& work, double dt);

/// The same for bodies; walls go on with the velocity their drive gave them.
void move_walls(const Model& model, State& state, Workspace& work, double dt);

}  // namespace trackbed
