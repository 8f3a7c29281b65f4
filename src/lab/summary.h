// summary.json: the whole run on one page, for people, scripts and studies.
#pragma once

#include <cstdint>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "lab/measure.h"
#include "lab/stage.h"

namespace trackbed {

/// One stage, when it is over.
struct StageSummary {
  std::string name, kind;
  std::int64_t steps = 0;
  double simulated = 0, wall = 0;  // [s]
  bool taken_over = false;         // from another run that began alike
  double energy_error = 0;         // change of the energy balance's total during the stage [J]
  std::vector<Result> results;     // found by the stage
  std::vector<Result> measures;    // all general measures at its end

  template <class A>
  void archive(A& a) {
    a(name, kind, steps, simulated, wall, taken_over, energy_error, results, measures);
  }
};

struct Summary {
  std::string title;
  std::uint64_t seed = 0;
  int threads = 1;
  nlohmann::ordered_json input;  // resolved, with every default
  std::vector<StageSummary> stages;
  std::vector<Result> measures;  // at the end, and the results of stages as "STAGE.RESULT"
  std::vector<double> force_limits;
  std::vector<int> force_counts;
  std::uint64_t state_hash = 0;
  double wall = 0;  // [s]
};

/// "0x" and 16 digits.
std::string hash_text(std::uint64_t hash);

/// {"version": ..., "stages": [...], "measures": {NAME: {"value", "unit"}}, ...}; numbers that do not exist
/// are null.
nlohmann::ordered_json to_json(const Summary& summary);

void write_summary(const Summary& summary, const std::filesystem::path& path);

}  // namespace trackbed
