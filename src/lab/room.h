// The room that stones may fill: the container, in front of all planes, outside all bodies.
#pragma once

#include <string>

#include "base/rng.h"
#include "io/read.h"
#include "lab/simulation.h"

namespace trackbed {

/// Refuses a case without a container, at a key.
void check_room(const Document& document, const std::string& key, const Simulation& sim);

/// Around the inside of the container, where its trays, sides or mesh have been moved to [m]. A side that has
/// been taken away counts where it was made.
Eigen::AlignedBox3d container_now(const Simulation& sim);

bool is_in_room(const Simulation& sim, const Vec3& point);

/// Volume of the part of a box that is in the region [m^3]; by counting points 1/100 of its shortest side
/// apart, in two dimensions those of the plane.
double volume_in(const Eigen::AlignedBox3d& box, const Region& region, const Space& space = {});

/// Evenly spread over the part of a box that is in the region, which must not be empty.
Vec3 point_in(const Eigen::AlignedBox3d& box, Rng& rng, const Region& region);

enum class Walls { all, of_triangles };

/// Whether a stone keeps clear [m] of the walls, of planes on their right side.
bool is_clear_of_walls(const Simulation& sim, int stone, double clearance, Walls which = Walls::all);

}  // namespace trackbed
