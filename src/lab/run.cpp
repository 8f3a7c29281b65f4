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
#include "lab/checkpoint.h"
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

  void open(double time) { start_ = time; }
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

/// Writes the last state; what this itself runs into is only told.
std::string leave_failure(const Simulation& sim, const Recorder& recorder) {
  try {
    return fmt::format("the last state is in {}", recorder.write_failure(sim).string());
  } catch (const std::exception& error) {
    return fmt::format("the last state could not be written: {}", error.what());
  }
}

/// What a stage is measured against when it is over.
struct StageStart {
  int stones = 0;
  double energy = 0;  // [J]
  std::int64_t step = 0;
  double time = 0;  // [s]
  Conditions before;

  template <class A>
  void archive(A& a) {
    a(stones, energy, step, time, before);
  }
};

/// Carries stages through one after the other and keeps where it stands.
class Course {
 public:
  Course(Simulation& sim, std::vector<NamedStage>& stages, Recorder& recorder, const RunOptions& options,
         Summary& summary)
      : sim_(sim),
        stages_(stages),
        recorder_(recorder),
        options_(options),
        summary_(summary),
        checkpoints_(options.out / "checkpoint", options.checkpoint_every),
        progress_(options.progress, options.quiet || !options.progress
                                        ? Progress::Style::quiet
                                        : Progress::style_of(options.progress)) {}

  void begin() {
    if (const auto bytes = options_.resume ? checkpoints_.newest() : std::nullopt)
      take_up(*bytes);
    else
      recorder_.begin();
  }

  void run() {
    for (; stage_ < stages_.size(); ++stage_) {
      sim_.stage = stages_[stage_].name;
      run_stage();
    }
    summary_.wall += seconds_since(clock_);
    checkpoints_.clear();
  }

 private:
  void run_stage() {
    StageProgress progress(progress_, fmt::format("{}/{} {}", stage_ + 1, stages_.size(), sim_.stage));
    Stage& stage = *stages_[stage_].stage;
    if (!is_open_) open();
    progress.open(start_.time);
    while (!stage.finished(sim_)) {
      stage.control(sim_);
      sim_.step();
      recorder_.after_step(sim_);
      progress.update(sim_, stage);
      look_up();
    }
    close();
    progress.close(sim_);
    if (stage_ + 1 < stages_.size()) leave_checkpoint(stage_ + 1);
  }

  void open() {
    start_.stones = sim_.state.clumps.size();
    start_.before = sim_.model;
    stages_[stage_].stage->open(sim_);
    sim_.number_by_place();
    sim_.places = places_of(sim_.state);
    start_.energy = energy_of(sim_.model, sim_.state).total();
    start_.step = sim_.state.step;
    start_.time = sim_.state.time;
    is_open_ = true;
  }

  void close() {
    inspect(sim_.model, sim_.state, sim_.work);
    StageSummary found;
    found.name = stages_[stage_].name;
    found.kind = stages_[stage_].kind;
    found.steps = sim_.state.step - start_.step;
    found.simulated = sim_.state.time - start_.time;
    found.energy_error = energy_of(sim_.model, sim_.state).total() - start_.energy;
    // All is written down before the stage's conditions, such as a lower friction, are gone.
    recorder_.close_stage(sim_);
    found.measures = measured(sim_);
    found.results = stages_[stage_].stage->close(sim_);
    sim_.restore(start_.before);
    check_count(sim_, start_.stones, found.results);
    found.wall = stage_wall_ + seconds_since(stage_clock_);
    stage_clock_ = Clock::now();
    stage_wall_ = 0;
    summary_.stages.push_back(std::move(found));
    is_open_ = false;
  }

  /// Between two steps.
  void look_up() {
    if (options_.stop && options_.stop()) {
      leave_checkpoint(stage_);
      throw Stopped(fmt::format("stopped in stage {} at step {}; --resume goes on from there", sim_.stage,
                                sim_.state.step));
    }
    if (checkpoints_.is_due()) leave_checkpoint(stage_);
  }

  void leave_checkpoint(std::size_t stage) {
    Archive a;
    std::string input = summary_.input.dump();
    std::uint64_t at = stage, fingerprint = hash(sim_.state);
    double wall = summary_.wall + seconds_since(clock_),
           stage_wall = stage_wall_ + seconds_since(stage_clock_);
    a(input, at, fingerprint, wall, stage_wall);
    archive(a);
    checkpoints_.write(a.bytes());
  }

  void take_up(std::string bytes) {
    Archive a(std::move(bytes));
    std::string input;
    std::uint64_t at = 0, fingerprint = 0;
    a(input);
    if (input != summary_.input.dump())
      throw InputError(fmt::format(
          "{}: the run there was another case ({}); leave out --resume to begin anew", options_.out.string(),
          difference(nlohmann::ordered_json::parse(input), summary_.input)));
    a(at, fingerprint, summary_.wall, stage_wall_);
    stage_ = at;
    archive(a);
    if (hash(sim_.state) != fingerprint)
      throw RunError(fmt::format("{}: the checkpoint there is of another version of this program",
                                 options_.out.string()));
    find_contacts(sim_.model, sim_.state, sim_.work);
  }

  /// Where all stands, in the order in which it is read.
  void archive(Archive& a) {
    a(sim_.state, static_cast<Conditions&>(sim_.model), sim_.model.domain, sim_.wall_reference, sim_.places,
      is_open_, start_, summary_.stages);
    if (is_open_) stages_[stage_].stage->archive(a);
    recorder_.archive(a);
  }

  Simulation& sim_;
  std::vector<NamedStage>& stages_;
  Recorder& recorder_;
  const RunOptions& options_;
  Summary& summary_;
  Checkpoints checkpoints_;
  Progress progress_;
  std::size_t stage_ = 0;  // that runs, or is next
  bool is_open_ = false;
  StageStart start_;
  const Clock::time_point clock_ = Clock::now();
  Clock::time_point stage_clock_ = clock_;
  double stage_wall_ = 0;  // of the stage, before the run was taken up [s]
};

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
  const double setting_up = seconds_since(start);
  run_stages(sim, stages, recorder, options, summary);
  summary.wall += setting_up;
  write_summary(summary, options.out / "summary.json");
  return summary;
}

}  // namespace trackbed
