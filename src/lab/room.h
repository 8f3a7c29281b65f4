// The room that stones may fill: the container, in front of all planes, outside all bodies.
#pragma once

#include <string>

#include "base/rng.h"
#include "io/read.h"
#include "lab/simulation.h"

namespace trackbed {

/// Refuses a case without a container, at a key.
void check_room(const Document& document, const std::string& key, const Simulation& sim);

bool is_in_room(const Simulation& sim, const Vec3& point);

/// [m^3]; by counting points 1/100 of the container's shortest side apart.
double room_volume(const Simulation& sim);

/// Evenly spread over the room.
Vec3 point_in_room(const Simulation& sim, Rng& rng);

enum class Walls { all, of_triangles };

/// Whether a stone keeps clear [m] of the walls, of planes on their right side.
bool is_clear_of_walls(const Simulation& sim, int stone, double clearance, Walls which = Walls::all);

}  // namespace trackbed
