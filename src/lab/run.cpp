#include "lab/run.h"

#include <fmt/format.h>

#include <new>

#include "base/error.h"
#include "base/stopwatch.h"
#include "dem/threads.h"
#include "io/echo.h"
#include "io/files.h"
#include "lab/checks.h"
#include "lab/course.h"
#include "lab/measure.h"

namespace trackbed {
namespace {

/// Writes the last state; what this itself runs into is only told.
std::string leave_failure(const Simulation& sim, const Recorder& recorder) {
  try {
    return fmt::format("the last state is in {}", recorder.write_failure(sim).string());
  } catch (const std::exception& error) {
    return fmt::format("the last state could not be written: {}", error.what());
  }
}

}  // namespace

std::vector<Result> carry_out(Simulation& sim, Stage& stage, const std::function<void()>& opened) {
  const Conditions before = sim.model;
  stage.open(sim);
  if (opened) opened();
  sim.number_by_place();
  sim.places = places_of(sim.state);
  while (!stage.finished(sim)) {
    stage.control(sim);
    sim.step();
  }
  std::vector<Result> results = stage.close(sim);
  sim.restore(before);
  return results;
}

void run_stages(Simulation& sim, std::vector<NamedStage>& stages, Recorder& recorder,
                const RunOptions& options, Summary& summary) {
  Course course(sim, stages, recorder, options, summary);
  course.begin();
  try {
    course.run();
  } catch (const RunError& error) {
    throw RunError(fmt::format("stage {}: {}\n  {}", sim.stage, error.what(), leave_failure(sim, recorder)));
  } catch (const std::bad_alloc&) {
    throw RunError(fmt::format("stage {}: there is not enough memory for {} stones with {} contacts",
                               sim.stage, sim.state.clumps.size(), sim.work.touching));
  }
  if (!summary.stages.empty()) summary.measures = summary.stages.back().measures;
  for (const StageSummary& stage : summary.stages)
    for (const Result& r : stage.results)
      summary.measures.push_back({stage.name + "." + r.name, r.value, r.dimension});
  summary.force_counts = force_histogram(sim, summary.force_limits);
  summary.state_hash = hash(sim.state);
}

std::vector<NamedStage> stages_of(const CaseInput& experiment) {
  std::vector<NamedStage> stages;
  for (const OneOf<StageInput>& stage : experiment.stages)
    stages.push_back({stage.input->name, stage.kind, stage.input->make(experiment)});
  return stages;
}

Simulation prepare_run(const Document& document, const CaseInput& experiment) {
  Simulation sim = make_simulation(document, experiment);
  check_measures(document, sim, "record.measures", experiment.record.measures);
  return sim;
}

Summary run_recorded(Simulation& sim, std::vector<NamedStage>& stages, const CaseInput& experiment,
                     const RunOptions& options, double setting_up) {
  Summary summary;
  summary.title = experiment.title;
  summary.seed = experiment.seed;
  summary.threads = use_threads(options.threads);
  summary.input = echo(experiment);
  summary.force_limits = experiment.record.force_bins;
  make_folder(options.out);
  std::filesystem::remove(options.out / "summary.json");  // of another run: what follows is not its
  Recorder recorder(sim, experiment.record, options.out);
  run_stages(sim, stages, recorder, options, summary);
  summary.wall += setting_up;
  write_summary(summary, options.out / "summary.json");
  return summary;
}

Summary run(const Document& document, const CaseInput& experiment, const RunOptions& options) {
  const Stopwatch watch;
  use_threads(options.threads);
  Simulation sim = prepare_run(document, experiment);
  std::vector<NamedStage> stages = stages_of(experiment);
  return run_recorded(sim, stages, experiment, options, watch.seconds());
}

}  // namespace trackbed
