// Pictures of the bed for the quick look: stones and bodies, and the forces between stones.
#pragma once

#include <filesystem>

#include "lab/simulation.h"

namespace trackbed {

/// Two views in one picture: all stones and bodies, from the front and above; and from the front those whose
/// centre lies behind the middle of the bed. Walls are left out.
void draw_bed(const Simulation& sim, const std::filesystem::path& png);

/// Force chains, from the front: a bar between the centres of two stones in touch, as thick as the force is
/// large (its area in proportion); bars to where stones touch bodies and walls. Bodies are drawn behind.
void draw_forces(const Simulation& sim, const std::filesystem::path& png);

}  // namespace trackbed
