// contacts.csv and stones.csv: everything about one moment, a row a contact and a row a stone.
#pragma once

#include <filesystem>

#include "lab/simulation.h"

namespace trackbed {

/// One row for each touching contact of pebbles: the stone and pebble on side 1, the stone or wall on side 2
/// (stone_2 is -1 for a wall), contact point, normal from 1 to 2, elastic forces on side 2, overlap, and
/// whether it slips.
void write_contacts(const Simulation& sim, const std::filesystem::path& path);

/// One row for each stone; displacements are those from `before`, zero for a stone that is not in it. Forces
/// are the sum of its contacts, without gravity; mean_stress is positive in compression.
void write_stones(const Simulation& sim, const StonePlaces& before, const std::filesystem::path& path);

}  // namespace trackbed
