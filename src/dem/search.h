// Two-level contact search. Level one pairs stones that lie near each other (a grid over bounding spheres)
// and stones with walls (the wall's facet tree). Level two walks the two trees of a pair and lists its
// candidates: pebbles nearer than the skin. A pair's list is made anew only when the motion of its own two
// bodies has used up the skin; so no list is ever too old, and neither skin nor margin changes any result.
#pragma once

#include "dem/model.h"
#include "dem/state.h"
#include "dem/workspace.h"

namespace trackbed {

/// Rotation matrices, bounds and travel of all bodies; sizes the workspace. Cheap when nothing is new.
void prepare(const Model& model, const State& state, Workspace& work);

/// Whether a stone or wall has moved so far that a stone outside the pairs may touch.
bool pairs_are_due(const State& state, Workspace& work);

/// Makes all pairs anew; the memory of contacts, and candidates that are still good, are carried over.
void rebuild_pairs(const Model& model, State& state, Workspace& work);

/// Makes the candidate lists of the block's pairs anew where they are due. To be called only when the block's
/// time of quiet is over.
void refresh(const Model& model, const State& state, const Workspace& work, PairBlock& block,
             PairGeometry& geometry);
void refresh(const Model& model, const State& state, const Workspace& work, WallBlock& block,
             WallGeometry& geometry);

}  // namespace trackbed
