// Runs a case from its first stage to its results.
#pragma once

#include <cstdio>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "io/read.h"
#include "lab/case.h"
#include "lab/recorder.h"
#include "lab/summary.h"

namespace trackbed {

struct RunOptions {
  std::filesystem::path out;  // folder of the results
  int threads = 0;            // 0: all cores
  bool quiet = false;
  std::FILE* progress = nullptr;  // where the progress line goes; nothing: nowhere
};

/// A stage ready to run; names are unique within a run.
struct NamedStage {
  std::string name, kind;
  std::unique_ptr<Stage> stage;
};

/// Runs the stages one after the other, writes down what happens, and what was found into `summary`, which
/// knows title, input and limits of the histogram. Throws RunError that names the stage; the last state is
/// then in out/failure.
void run_stages(Simulation& sim, std::vector<NamedStage>& stages, Recorder& recorder,
                const RunOptions& options, Summary& summary);

/// The stages of a case.
std::vector<NamedStage> stages_of(const CaseInput& experiment);

/// Checks and makes all that a run needs, also the names in record.measures. Throws InputError.
Simulation prepare_run(const Document& document, const CaseInput& experiment);

/// Runs a case and leaves in options.out what recorder.h lists, and summary.json, which is returned.
Summary run(const Document& document, const CaseInput& experiment, const RunOptions& options);

}  // namespace trackbed
