// Pictures of the bed for the quick look: stones and bodies, and the forces between stones.
#pragma once

#include <filesystem>
#include <optional>
#include <vector>

#include "lab/simulation.h"

namespace trackbed {

/// Two views in one picture: all stones and bodies, from the front and above; and from the front those whose
/// centre lies behind the middle of the bed. Walls are left out.
void draw_bed(const Simulation& sim, const std::filesystem::path& png);

/// How far stones have moved, by colour from blue (not at all) over yellow to red (`scale` [m] or more; by
/// default the largest displacement): the stones behind the middle of the bed from the front, as an observer
/// of a cut through it would see them, and all from above.
void draw_displacements(const Simulation& sim, const std::vector<Vec3>& moved, std::optional<double> scale,
                        const std::filesystem::path& png);

/// Force chains, from the front: a bar between the centres of two stones in touch, as thick as the force is
/// large (its area in proportion); bars to where stones touch bodies and walls. Bodies are drawn behind.
void draw_forces(const Simulation& sim, const std::filesystem::path& png);

}  // namespace trackbed
