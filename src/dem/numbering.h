// Stones numbered by place: neighbours in the bed become neighbours in memory, which the speed of large beds
// hangs on.
#pragma once

#include "dem/state.h"

namespace trackbed {

/// Numbers the stones layer by layer across the longest extent of the bed, row by row within a layer; a bed
/// of many rows by strips of some of them. Ids and contacts go along; the workspace is no longer good. Sums
/// of forces change their order, so this belongs between stages, where every run does it alike.
void number_by_place(State& state);

}  // namespace trackbed
