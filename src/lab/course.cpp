#include "lab/course.h"

#include <fmt/format.h>

#include <cmath>

#include "base/error.h"
#include "io/echo.h"
#include "lab/measure.h"

namespace trackbed {
namespace {

std::vector<Result> measured(const Simulation& sim) {
  std::vector<Result> results;
  for (const Measure& m : measures_of(sim)) results.push_back({m.name, m.value(sim), m.dimension});
  return results;
}

/// Of the state, and of the shapes that it names: their files may have changed while the input stayed.
std::uint64_t fingerprint_of(const Simulation& sim) {
  return hash(sim.state) ^ hash_of_shapes(sim.model);
}

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

}  // namespace

Course::Course(Simulation& sim, std::vector<NamedStage>& stages, Recorder& recorder,
               const RunOptions& options, Summary& summary)
    : sim_(sim),
      stages_(stages),
      recorder_(recorder),
      options_(options),
      summary_(summary),
      checkpoints_(options.out / "checkpoint", options.checkpoint_every),
      ends_(options.keep, summary.input, sim.model),
      progress_(options.quiet ? nullptr : options.progress) {}

void Course::begin() {
  if (const auto bytes = options_.resume ? checkpoints_.newest() : std::nullopt) return take_up(*bytes);
  recorder_.begin();
  take_over();
}

void Course::run() {
  for (; stage_ < stages_.size(); ++stage_) {
    sim_.stage = stages_[stage_].name;
    run_stage();
  }
  summary_.wall += watch_.seconds();
  checkpoints_.clear();
}

void Course::run_stage() {
  Stage& stage = *stages_[stage_].stage;
  told_.stage = fmt::format("{}/{} {}", stage_ + 1, stages_.size(), sim_.stage);
  if (!is_open_) open();
  while (!stage.finished(sim_)) {
    stage.control(sim_);
    sim_.step();
    recorder_.after_step(sim_);
    progress_.update(progress());
    look_up();
  }
  close();
  progress_.end_stage(progress());
  if (stage_ + 1 == stages_.size()) return;
  leave_end();
  leave_checkpoint(stage_ + 1);
}

void Course::open() {
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

void Course::close() {
  Stage& stage = *stages_[stage_].stage;
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
  found.results = stage.close(sim_);
  if (const ResultTable* table = stage.table()) recorder_.write_table(sim_, *table);
  sim_.restore(start_.before);
  check_count(sim_, start_.stones, found.results);
  found.wall = stage_wall_ + stage_watch_.lap();
  stage_wall_ = 0;
  summary_.stages.push_back(std::move(found));
  is_open_ = false;
}

const ProgressState& Course::progress() {
  const Profile& p = sim_.work.profile;
  const double all = p.search + p.forces + p.gather + p.motion;
  const double done = sim_.state.time - start_.time, left = stages_[stage_].stage->remaining(sim_);
  told_.time = sim_.state.time;
  told_.steps = static_cast<std::uint64_t>(sim_.state.step);
  told_.contacts = static_cast<std::uint64_t>(sim_.work.touching);
  told_.fraction_done = left > 0 ? done / (done + left) : 0.0;
  told_.awaited = stages_[stage_].stage->awaited(sim_);
  told_.search_share = all > 0 ? p.search / all : 0.0;
  return told_;
}

/// Between two steps.
void Course::look_up() {
  if (options_.stop && options_.stop()) {
    leave_checkpoint(stage_);
    throw Stopped(fmt::format("stopped in stage {} at step {}; --resume goes on from there", sim_.stage,
                              sim_.state.step));
  }
  if (checkpoints_.is_due()) leave_checkpoint(stage_);
}

void Course::leave_checkpoint(std::size_t stage) {
  Archive a;
  std::string input = summary_.input.dump();
  std::uint64_t at = stage, fingerprint = fingerprint_of(sim_);
  double wall = summary_.wall + watch_.seconds(), stage_wall = stage_wall_ + stage_watch_.seconds();
  a(input, at, fingerprint, wall, stage_wall);
  archive(a);
  checkpoints_.write(a.bytes());
}

void Course::take_up(std::string bytes) {
  Archive a(std::move(bytes));
  std::string input;
  std::uint64_t at = 0, fingerprint = 0;
  a(input);
  if (input != summary_.input.dump())
    throw InputError(fmt::format("{}: the run there was another case ({}); leave out --resume to begin anew",
                                 options_.out.string(),
                                 difference(nlohmann::ordered_json::parse(input), summary_.input)));
  a(at, fingerprint, summary_.wall, stage_wall_);
  stage_ = at;
  archive(a);
  if (fingerprint_of(sim_) != fingerprint)
    throw RunError(
        fmt::format("{}: the checkpoint there is of another version of this program, or a file of shapes has "
                    "changed since",
                    options_.out.string()));
  find_contacts(sim_.model, sim_.state, sim_.work);
}

void Course::leave_end() {
  const std::string& name = stages_[stage_].name;
  std::optional<Archive> end = ends_.begin(name);
  if (!end) return;
  archive_between(*end);
  ends_.keep(name, *end);
}

void Course::take_over() {
  for (std::size_t k = stages_.size(); k-- > 1;) {
    std::optional<Archive> end = ends_.find(stages_[k - 1].name);
    if (!end) continue;
    archive_between(*end);
    for (StageSummary& stage : summary_.stages) stage.taken_over = true;
    stage_ = k;
    find_contacts(sim_.model, sim_.state, sim_.work);
    return;
  }
}

/// What is left of the stages before.
void Course::archive_between(Archive& a) {
  a(sim_.state, static_cast<Conditions&>(sim_.model), sim_.model.domain, sim_.wall_reference,
    summary_.stages);
}

/// Where all stands, in the order in which it is read.
void Course::archive(Archive& a) {
  archive_between(a);
  a(sim_.places, is_open_, start_);
  if (is_open_) stages_[stage_].stage->archive(a);
  recorder_.archive(a);
}

}  // namespace trackbed
