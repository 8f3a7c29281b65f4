// Runs a case from its first stage to its results.
#pragma once

#include <cstdio>
#include <filesystem>
#include <functional>
#include <memory>
#include <stdexcept>
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
  bool resume = false;            // from the last checkpoint, if there is one
  double checkpoint_every = 600;  // wall time between two checkpoints; there is one at each stage's end [s]
  std::filesystem::path keep{};   // for ends of stages (stage_ends.h) and reduced ground; empty: none is kept
  std::function<bool()> stop{};   // asked after each step: whether to leave a checkpoint and end
};

/// A run that was asked to stop, and left a checkpoint.
class Stopped : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// A stage ready to run; names are unique within a run.
struct NamedStage {
  std::string name, kind;
  std::unique_ptr<Stage> stage;
};

/// Carries a stage through without writing anything down; returns what it found. `opened` is called after its
/// opening.
std::vector<Result> carry_out(Simulation& sim, Stage& stage, const std::function<void()>& opened = {});

/// Runs the stages one after the other, writes down what happens, and what was found into `summary`, which
/// knows title, input and limits of the histogram. Where it stands is kept in out/checkpoint meanwhile.
/// Throws RunError that names the stage; the last state is then in out/failure. Throws Stopped, and
/// InputError when the checkpoint to be taken up is of another case.
void run_stages(Simulation& sim, std::vector<NamedStage>& stages, Recorder& recorder,
                const RunOptions& options, Summary& summary);

/// Runs these stages of a case with the simulation and leaves in options.out what recorder.h lists, and
/// summary.json, which is returned. `setting_up`: wall time before, which counts as the run's [s]. Throws as
/// run_stages does.
Summary run_recorded(Simulation& sim, std::vector<NamedStage>& stages, const CaseInput& experiment,
                     const RunOptions& options, double setting_up = 0);

/// The stages of a case.
std::vector<NamedStage> stages_of(const CaseInput& experiment);

/// Checks and makes all that a run needs, also the names in record.measures. Throws InputError.
Simulation prepare_run(const Document& document, const CaseInput& experiment);

/// Runs a case and leaves in options.out what recorder.h lists, and summary.json, which is returned. A run
/// that is taken up again (resume) ends with the same bits as one that was never stopped.
Summary run(const Document& document, const CaseInput& experiment, const RunOptions& options);

}  // namespace trackbed
