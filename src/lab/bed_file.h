// Beds as plain lists of spheres, to exchange with other codes.
#pragma once

#include <array>
#include <filesystem>
#include <vector>

#include "lab/simulation.h"

namespace trackbed {

/// Adds plane walls of material 0 around a square floor of the given side [m], one corner at the origin, open
/// above: floor, left, right, front, back.
void add_open_box(Simulation& sim, double side);

/// Reads lines "x y z r [clump]" (SI; # starts a comment) into a simulation of stones in an open
/// box of the given side [m]. Lines with the same clump number are
/// one stone; without a number each sphere is one. Stones whose spheres have the same radii and distances
/// share a template, placed by a least-squares fit. Mass is density x volume of the union of the spheres,
/// inertia that of the spheres scaled to this mass. Throws InputError with the line.
Simulation read_bed(const std::filesystem::path& file, double side, double density);

}  // namespace trackbed
