// Beds at rest, kept in a file, so that what takes minutes to settle is settled once.
#pragma once

#include <filesystem>

#include "lab/simulation.h"

namespace trackbed {

/// Writes the pebbles and mass properties of the templates, the pose of every stone, and pose and applied
/// force of every body that is placed. Not kept are motion, and the memory of contacts. Numbers read back to
/// the same bits. Throws RunError.
void write_kept_bed(const Simulation& sim, const std::filesystem::path& file);

/// Puts a kept bed into a simulation with the same walls and bodies: its templates and stones replace those
/// that are there. Stones are at rest; sim.changed() is to be called afterwards. Throws
/// InputError for a file that is none.
void read_kept_bed(const std::filesystem::path& file, Simulation& sim);

}  // namespace trackbed
