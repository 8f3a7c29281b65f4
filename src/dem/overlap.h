// Whether stones, walls and bodies are in each other's way; for placing stones, not for a step.
#pragma once

#include "dem/model.h"
#include "dem/state.h"

namespace trackbed {

/// Less than `clearance` [m] between any pebbles of two stones.
bool stones_meet(const Model& model, const Clumps& clumps, int i, int j, double clearance);

/// Less than `clearance` [m] between any pebble of a stone and a wall, or a centre beyond a plane.
bool stone_meets_wall(const Model& model, const State& state, int clump, int wall, double clearance);

/// Whether a point of the wall's frame [m] lies inside a closed wall mesh (its winding number is 1).
bool is_inside(const WallShape& shape, const Vec3& point);

}  // namespace trackbed
