#include "lab/run.h"

#include <fmt/format.h>

#include <chrono>
#include <cmath>
#include <new>

#include "base/error.h"
#include "dem/threads.h"
#include "io/echo.h"
#include "io/files.h"
#include "io/progress.h"
#include "lab/measure.h"

namespace trackbed {
namespace {

using Clock = std::chrono::steady_clock;

double seconds_since(Clock::time_point start) {
  return std::chrono::duration<double>(Clock::now() - start).count();
}

std::vector<Result> measured(const Simulation& sim) {
  std::vector<Result> results;
  for (const Measure& m : measures_of(sim)) results.push_back({m.name, m.value(sim), m.dimension});
  return results;
}

/// Tells how a stage is getting on.
class StageProgress {
 public:
  StageProgress(Progress& progress, std::string title) : progress_(progress) {
    state_.stage = std::move(title);
  }

  void open(const Simulation& sim) { start_ = sim.state.time; }
  void update(const Simulation& sim, const Stage& stage) {
    const double done = sim.state.time - start_, left = stage.remaining(sim);
    state_.fraction_done = left > 0 ? done / (done + left) : 0.0;
    look_at(sim);
    progress_.update(state_);
  }
  void close(const Simulation& sim) {
    look_at(sim);
    progress_.end_stage(state_);
  }

 private:
  void look_at(const Simulation& sim) {
    const Profile& p = sim.work.profile;
    const double all = p.search + p.forces + p.gather + p.motion;
    state_.time = sim.state.time;
    state_.steps = static_cast<std::uint64_t>(sim.state.step);
    state_.contacts = static_cast<std::uint64_t>(sim.work.touching);
    state_.search_share = all > 0 ? p.search / all : 0.0;
  }

  Progress& progress_;
  ProgressState state_;
  double start_ = 0;  // [s]
};

/// Stones are added and removed only by stages that say so in their results.
void check_count(const Simulation& sim, int before, const std::vector<Result>& results) {
  double expected = before;
  for (const Result& r : results) {
    if (r.name == "added") expected += r.value;
    if (r.name == "removed") expected -= r.value;
  }
  if (sim.state.clumps.size() != std::lround(expected))
    throw RunError(fmt::format("there are {} stones at the end, {} should be there: stones were lost or made",
                               sim.state.clumps.size(), std::lround(expected)));
}

/// The stage from its first step to its end.
StageSummary run_stage(Simulation& sim, NamedStage& named, Recorder& recorder, StageProgress& progress) {
  const Clock::time_point start = Clock::now();
  const int stones = sim.state.clumps.size();
  Stage& stage = *named.stage;
  stage.open(sim);
  sim.number_by_place();
  recorder.open_stage(sim);
  progress.open(sim);
  const double energy = energy_of(sim.model, sim.state).total();
  const std::int64_t first_step = sim.state.step;
  const double first_time = sim.state.time;
  while (!stage.finished(sim)) {
    stage.control(sim);
    sim.step();
    recorder.after_step(sim);
    progress.update(sim, stage);
  }
  inspect(sim.model, sim.state, sim.work);
  StageSummary found;
  found.name = named.name;
  found.kind = named.kind;
  found.steps = sim.state.step - first_step;
  found.simulated = sim.state.time - first_time;
  found.energy_error = energy_of(sim.model, sim.state).total() - energy;
  // All is written down before the stage undoes what it has set, such as a lower friction.
  recorder.close_stage(sim);
  found.measures = measured(sim);
  found.results = stage.close(sim);
  check_count(sim, stones, found.results);
  found.wall = seconds_since(start);
  progress.close(sim);
  return found;
}

/// Writes the last state; what this itself runs into is only told.
std::string leave_failure(const Simulation& sim, const Recorder& recorder) {
  try {
    return fmt::format("the last state is in {}", recorder.write_failure(sim).string());
  } catch (const std::exception& error) {
    return fmt::format("the last state could not be written: {}", error.what());
  }
}

}  // namespace

void run_stages(Simulation& sim, std::vector<NamedStage>& stages, Recorder& recorder,
                const RunOptions& options, Summary& summary) {
  const Clock::time_point start = Clock::now();
  const bool silent = options.quiet || !options.progress;
  Progress progress(options.progress, silent ? Progress::Style::quiet : Progress::style_of(options.progress));
  for (std::size_t k = 0; k < stages.size(); ++k) {
    sim.stage = stages[k].name;
    StageProgress stage_progress(progress, fmt::format("{}/{} {}", k + 1, stages.size(), sim.stage));
    try {
      summary.stages.push_back(run_stage(sim, stages[k], recorder, stage_progress));
    } catch (const RunError& error) {
      throw RunError(
          fmt::format("stage {}: {}\n  {}", sim.stage, error.what(), leave_failure(sim, recorder)));
    } catch (const std::bad_alloc&) {
      throw RunError(fmt::format("stage {}: there is not enough memory for {} stones with {} contacts",
                                 sim.stage, sim.state.clumps.size(), sim.work.touching));
    }
  }
  if (!summary.stages.empty()) summary.measures = summary.stages.back().measures;
  for (const StageSummary& stage : summary.stages)
    for (const Result& r : stage.results)
      summary.measures.push_back({stage.name + "." + r.name, r.value, r.dimension});
  summary.force_counts = force_histogram(sim, summary.force_limits);
  summary.state_hash = hash(sim.state);
  summary.wall = seconds_since(start);
}

std::vector<NamedStage> stages_of(const CaseInput& experiment) {
  std::vector<NamedStage> stages;
  for (const OneOf<StageInput>& stage : experiment.stages)
    stages.push_back({stage.input->name, stage.kind, stage.input->make(experiment)});
  return stages;
}

Simulation prepare_run(const Document& document, const CaseInput& experiment) {
  Simulation sim = make_simulation(document, experiment);
  for (const std::string& name : experiment.record.measures)
    if (const auto hint = hint_for_measure(sim, name))
      document.fail("record.measures", "there is no measure called " + name, *hint);
  return sim;
}

Summary run(const Document& document, const CaseInput& experiment, const RunOptions& options) {
  const Clock::time_point start = Clock::now();
  Summary summary;
  summary.title = experiment.title;
  summary.seed = experiment.seed;
  summary.threads = use_threads(options.threads);
  summary.input = echo(experiment);
  summary.force_limits = experiment.record.force_bins;

  Simulation sim = prepare_run(document, experiment);
  std::vector<NamedStage> stages = stages_of(experiment);
  make_folder(options.out);
  Recorder recorder(sim, experiment.record, options.out);
  run_stages(sim, stages, recorder, options, summary);
  summary.wall = seconds_since(start);
  write_summary(summary, options.out / "summary.json");
  return summary;
}

}  // namespace trackbed
