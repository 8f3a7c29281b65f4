// What a passage has left of its sleepers' peak forces: the way from the track to the bed.
#pragma once

#include <filesystem>
#include <vector>

namespace trackbed {

struct SleeperPeak {
  int number = 0;    // counted from the bridge
  double force = 0;  // largest on the ground during the passage [N]
};

/// Peak forces of the sleepers on the embankments, or of those with the given numbers, in their order along
/// the track, from the sleepers.csv that a track case has left or its folder. Throws InputError when it is
/// none, or a sleeper is not in it.
std::vector<SleeperPeak> read_peaks(const std::filesystem::path& file_or_folder,
                                    const std::vector<double>& numbers = {});

}  // namespace trackbed
