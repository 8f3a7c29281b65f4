// Levels of force that a moving wall or body crosses, and what is measured at each: the load cases of a track
// in one run of the bed.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "lab/stage.h"

namespace trackbed {

/// The keys of the stage `move` that have to do with levels.
struct LevelsInput {
  std::vector<double> levels;                       // [N], ascending
  std::optional<std::filesystem::path> from_track;  // sleepers.csv of a passage, or its folder
  std::vector<double> sleepers;                     // those of it that count; empty: all
  std::vector<std::string> measures;                // at each level

  /// Refuses levels from a file that is no track's result, and unknown measures. `here`: of the stage.
  void check(const Document& document, const Simulation& sim, const std::string& here) const;
  bool any() const { return !levels.empty() || from_track; }
};

void declare(Fields& f, LevelsInput& in);
/// What the levels give.
void declare_results(Fields& f, const LevelsInput& in);

/// Notes the first crossing of each level.
class Levels {
 public:
  /// Throws InputError when the file of `in` cannot be read.
  explicit Levels(const LevelsInput& in);

  void open(const Simulation& sim);
  /// Adds a row for each level that the force [N] has reached for the first time.
  void look(const Simulation& sim, double force, double distance);
  /// Whether the highest was reached; false when there are none.
  bool all_crossed() const { return !levels_.empty() && crossed() == levels_.size(); }

  /// The distance at each level that was crossed: "distance_at_80_kN", "distance_at_sleeper_-4".
  std::vector<Result> results() const;
  /// Level, number of the sleeper where levels are from a track, force, distance, time, and the measures.
  const ResultTable* table() const { return levels_.empty() ? nullptr : &table_; }
  void archive(Archive& a) { a(table_); }

 private:
  struct Level {
    double force = 0;  // [N]
    int sleeper = 0;   // of the track it comes from
  };
  std::size_t crossed() const { return table_.rows.size(); }

  std::vector<Level> levels_;  // ascending
  std::vector<std::string> measures_;
  bool of_sleepers_ = false;
  ResultTable table_{"levels", {}, {}};
};

}  // namespace trackbed
