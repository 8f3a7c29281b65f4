// Beds at rest, kept in a file, so that what takes minutes to settle is settled once.
#pragma once

#include <filesystem>

#include "lab/simulation.h"

namespace trackbed {

/// Writes the pebbles and mass properties of the templates, and the whole state. Throws RunError.
void write_kept_bed(Simulation& sim, const std::filesystem::path& file);

/// Puts a kept bed into a simulation with the same materials, walls and bodies: its templates and state, to
/// the same bits, take the place of those that are there; sim.changed() is to be called afterwards. Throws
/// InputError for a file that is none.
void read_kept_bed(const std::filesystem::path& file, Simulation& sim);

}  // namespace trackbed
