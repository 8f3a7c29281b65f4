// Runs a case from its first stage to its results.
#pragma once

#include <cstdio>
#include <filesystem>
#include <string>
#include <vector>

#include "io/read.h"
#include "lab/case.h"

namespace trackbed {

struct RunOptions {
  std::filesystem::path out;  // folder of the results
  int threads = 0;            // 0: all cores
  bool quiet = false;
  std::FILE* progress = nullptr;  // where the progress line goes; nothing: nowhere
};

/// What a run left behind.
struct RunResults {
  std::vector<Result> measures;
  std::uint64_t state_hash = 0;
  double seconds = 0;  // wall time
  std::filesystem::path out;
};

/// Runs all stages and writes series.csv, contacts.csv, stones.csv, ParaView files, pictures and summary.json into
/// options.out. Throws RunError when the run fails; a snapshot of the last state is then in out/failure.
RunResults run(const Document& document, const CaseInput& experiment, const RunOptions& options);

}  // namespace trackbed
