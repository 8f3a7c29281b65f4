// One step of the simulation.
#pragma once

#include "dem/model.h"
#include "dem/state.h"
#include "dem/workspace.h"

namespace trackbed {

/// Makes forces, contacts and the planned step belong to the present positions; to be called before the first
/// step and after anything but step() changed the state (stones added, moved, removed; walls placed).
void settle_contacts(const Model& model, State& state, Workspace& work);

/// Makes an empty workspace good again for a state whose forces and contacts are those of its positions, and
/// changes nothing that bears on the future.
void find_contacts(const Model& model, State& state, Workspace& work);

/// Carries the state from t to t + dt. Throws RunError when the state is no longer sound (see inspect.h).
void step(const Model& model, State& state, Workspace& work);

}  // namespace trackbed
