// Which stones, and which stones and walls, lie near each other by their bounding spheres.
#pragma once

#include <utility>
#include <vector>

#include "dem/model.h"
#include "dem/state.h"
#include "dem/workspace.h"

namespace trackbed {

using Pairs = std::vector<std::pair<int, int>>;

/// All (i, j), i < j, with less than the margin between their bounding spheres, ascending.
Pairs near_clumps(const Clumps& clumps, const Workspace& work);

/// All (wall, clump) with less than the margin between the wall and the bounding sphere, ascending.
Pairs near_walls(const Model& model, const State& state, const Workspace& work);

}  // namespace trackbed
