// Forces of all contacts at the present positions, and their sums on stones and walls.
#pragma once

#include "dem/model.h"
#include "dem/state.h"
#include "dem/workspace.h"

namespace trackbed {

/// Refreshes the candidates that are due and lets every touching contact respond, for a step of length dt
/// [s]. One patch is summed by one thread, its contacts in ascending order: the same bits for any number of
/// threads.
void contact_forces(const Model& model, State& state, Workspace& work, double dt);

/// The part of it that one block of wall pairs does; returns the number of contacts.
int wall_block_forces(const Model& model, State& state, Workspace& work, std::size_t block, double dt);

/// Adds what came from other patches and from walls on the stones, and sums on the walls.
void gather_forces(const Model& model, State& state, Workspace& work, double dt);

}  // namespace trackbed
