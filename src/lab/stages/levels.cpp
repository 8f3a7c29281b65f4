#include "lab/stages/levels.h"

#include <fmt/format.h>

#include <algorithm>

#include "base/error.h"
#include "lab/checks.h"
#include "lab/measure.h"
#include "lab/track/sleeper_peaks.h"

namespace trackbed {
namespace {

std::string name_of_level(double force) {
  return fmt::format("distance_at_{:g}_kN", 1e-3 * force);
}

}  // namespace

void declare(Fields& f, LevelsInput& in) {
  f.quantities(
      "levels", in.levels, Dimension::force, {.above = 0},
      "forces against the motion at whose first crossing a row is added to stages/STAGE-levels.csv; the "
      "motion ends at the highest where no other key says when");
  f.path("levels_from", in.from_track,
         "levels are the peak forces of sleepers in a passage: folder of the results of a track case, or the "
         "sleepers.csv in it");
  f.quantities("sleepers", in.sleepers, Dimension::none, {},
               "numbers of the sleepers in levels_from; by default all on ballast");
  f.texts("measures", in.measures, "measures in the rows of levels");
  f.check(std::ranges::is_sorted(in.levels), "levels", "the forces do not ascend", "sort them");
  f.check(in.levels.empty() || !in.from_track, "levels_from",
          "levels and levels_from say the same thing twice", "give one of them");
  f.check(in.sleepers.empty() || in.from_track, "sleepers", "there is no track that these sleepers are of",
          "give levels_from too, or leave them out");
  f.check(in.measures.empty() || in.any(), "measures", "there are no levels at which to measure",
          "give levels, or leave them out");
}

void declare_results(Fields& f, const LevelsInput& in) {
  f.gives("distance_at_NUMBER_kN", Dimension::length, "with levels: at each that was reached", false);
  for (const double force : in.levels) f.gives(name_of_level(force), Dimension::length, "at this level");
  f.gives("distance_at_sleeper_NUMBER", Dimension::length, "with levels_from: at each that was reached",
          in.from_track.has_value());
}

void LevelsInput::check(const Document& document, const Simulation& sim, const std::string& here) const {
  check_measures(document, sim, here + ".measures", measures);
  if (!from_track) return;
  try {
    read_peaks(*from_track, sleepers);
  } catch (const InputError& error) {
    document.fail(here + ".levels_from", error.what(),
                  "give the folder that `trackbed run` of a track case has left, and sleepers of it");
  }
}

Levels::Levels(const LevelsInput& in) : measures_(in.measures), of_sleepers_(in.from_track.has_value()) {
  for (const double force : in.levels) levels_.push_back({force, 0});
  if (in.from_track)
    for (const SleeperPeak& peak : read_peaks(*in.from_track, in.sleepers))
      levels_.push_back({peak.force, peak.number});
  std::ranges::stable_sort(levels_, {}, &Level::force);
}

void Levels::open(const Simulation& sim) {
  table_.columns = {{"level", Dimension::force}};
  if (of_sleepers_) table_.columns.push_back({"sleeper"});
  table_.columns.insert(
      table_.columns.end(),
      {{"force", Dimension::force}, {"distance", Dimension::length}, {"time", Dimension::time}});
  for (const Measure& m : measures_called(sim, measures_)) table_.columns.push_back({m.name, m.dimension});
}

void Levels::look(const Simulation& sim, double force, double distance) {
  while (crossed() < levels_.size() && force >= levels_[crossed()].force) {
    const Level& level = levels_[crossed()];
    std::vector<double> row{level.force};
    if (of_sleepers_) row.push_back(level.sleeper);
    row.insert(row.end(), {force, distance, sim.state.time});
    for (const Measure& m : measures_called(sim, measures_)) row.push_back(m.value(sim));
    table_.rows.push_back(std::move(row));
  }
}

std::vector<Result> Levels::results() const {
  std::vector<Result> results;
  const auto distance = std::ranges::find(table_.columns, "distance", &Column::name);
  for (std::size_t k = 0; k < crossed(); ++k)
    results.push_back({of_sleepers_ ? fmt::format("distance_at_sleeper_{:+d}", levels_[k].sleeper)
                                    : name_of_level(levels_[k].force),
                       table_.rows[k].at(static_cast<std::size_t>(distance - table_.columns.begin())),
                       Dimension::length});
  return results;
}

}  // namespace trackbed
