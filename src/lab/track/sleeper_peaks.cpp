#include "lab/track/sleeper_peaks.h"

#include <fmt/format.h>

#include <algorithm>

#include "base/error.h"
#include "io/csv.h"

namespace trackbed {
namespace {

std::filesystem::path table_of(const std::filesystem::path& file_or_folder) {
  if (!std::filesystem::is_directory(file_or_folder)) return file_or_folder;
  const std::filesystem::path file = file_or_folder / "sleepers.csv";
  if (std::filesystem::exists(file)) return file;
  throw InputError(
      fmt::format("{}: no results of a track case: there is no sleepers.csv", file_or_folder.string()));
}

}  // namespace

std::vector<SleeperPeak> read_peaks(const std::filesystem::path& file_or_folder,
                                    const std::vector<double>& numbers) {
  const std::filesystem::path file = table_of(file_or_folder);
  const CsvTable table(file);
  if (!table.has("number") || !table.has("zone") || !table.has("peak_force"))
    throw InputError(
        fmt::format("{}: not the sleepers.csv of a track case: it lacks a column number, zone or "
                    "peak_force",
                    file.string()));
  const std::vector<double> number = table.numbers("number", Dimension::none),
                            force = table.numbers("peak_force", Dimension::force);
  const std::vector<std::string> zone = table.texts("zone");
  std::vector<SleeperPeak> peaks;
  for (std::size_t k = 0; k < number.size(); ++k) {
    const bool on_ballast = zone[k] == "approach" || zone[k] == "departure";
    const bool is_asked = numbers.empty() || std::ranges::find(numbers, number[k]) != numbers.end();
    if (on_ballast && is_asked) peaks.push_back({static_cast<int>(number[k]), force[k]});
  }
  for (const double asked : numbers)
    if (std::ranges::find(peaks, static_cast<int>(asked), &SleeperPeak::number) == peaks.end() ||
        asked != static_cast<int>(asked))
      throw InputError(fmt::format("{}: there is no sleeper {:g} on ballast", file.string(), asked));
  if (peaks.empty()) throw InputError(fmt::format("{}: there are no sleepers on ballast", file.string()));
  return peaks;
}

}  // namespace trackbed
