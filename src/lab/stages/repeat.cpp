#include <algorithm>
#include <iterator>
#include <limits>
#include <memory>
#include <string>
#include <vector>

#include "lab/checks.h"
#include "lab/measure.h"
#include "lab/stages/table.h"

namespace trackbed {
namespace {

struct RepeatInput : StageInput {
  int times = 1;
  std::vector<std::string> measures;
  std::vector<OneOf<StageInput>> stages;
  void check(const Document& document, const CaseInput& experiment, const Simulation& sim) const override {
    check_stage_list(document, stages, experiment, sim);
    check_measures(document, sim, here + ".measures", measures);
  }
  void follow(const Document& document, Presence& presence) const override {
    for (int time = 0; time < std::min(times, 2); ++time)  // what the first leaves is what the second finds
      for (const OneOf<StageInput>& stage : stages) stage.input->follow(document, presence);
  }
  std::unique_ptr<Stage> make(const CaseInput& experiment) const override;
};

void declare(Fields& f, RepeatInput& in) {
  declare_common(f, in);
  f.integer(required("times"), in.times, {.at_least = 1}, "how often its stages follow each other");
  f.texts("measures", in.measures, "further columns of its table: measured at the end of each of its stages");
  declare_stages(f, in.stages, "what happens each time, in this order");
  f.check(!in.stages.empty(), "stages", "there is no stage to repeat", "add [[stages.stages]] with a kind");
  f.gives("times", Dimension::none, "how often its stages ran");
  f.gives("added", Dimension::none, "stones, all times together; where there are any");
  f.gives("removed", Dimension::none, "stones, all times together; where there are any");
  f.gives("STAGE.RESULT", Dimension::none, "what its stages gave the last time, in its own unit", false);
  for (const OneOf<StageInput>& stage : in.stages) {
    const std::string& name = stage.input->name;
    for (const Foreseen& r : foreseen_results(stage)) f.gives(name + "." + r.name, r.dimension, "its result");
    for (const std::string& measure : in.measures) f.gives(name + "." + measure, Dimension::none, "measured");
    f.gives(name + ".time", Dimension::time, "when it ended");
  }
}

class Repeat : public Stage {
 public:
  Repeat(const RepeatInput& in, const CaseInput& experiment) : in_(in), experiment_(experiment) {}

  void open(Simulation& sim) override {
    start_ = sim.state.time;
    row_ = {1};
    open_stage(sim);
  }
  void control(Simulation& sim) override {
    while (!is_last() && stage_->finished(sim)) {
      close_stage(sim);
      next();
      open_stage(sim);
    }
    stage_->control(sim);
  }
  bool finished(const Simulation& sim) override { return is_last() && stage_->finished(sim); }
  double remaining(const Simulation& sim) const override {
    const double done = cycle_ + static_cast<double>(at_) / static_cast<double>(in_.stages.size());
    return done > 0 ? (sim.state.time - start_) / done * (in_.times - done) : 0.0;
  }
  Awaited awaited(const Simulation& sim) const override { return stage_->awaited(sim); }

  /// What its stages found the last time; stones added and removed, of all times.
  std::vector<Result> close(Simulation& sim) override {
    close_stage(sim);
    next();
    std::vector<Result> results{{"times", static_cast<double>(cycle_), Dimension::none}};
    if (added_ > 0) results.push_back({"added", added_, Dimension::none});
    if (removed_ > 0) results.push_back({"removed", removed_, Dimension::none});
    for (std::size_t k = 1; k < table_.columns.size(); ++k)
      results.push_back({table_.columns[k].name, table_.rows.back()[k], table_.columns[k].dimension});
    return results;
  }
  const ResultTable* table() const override { return &table_; }
  void archive(Archive& a) override {
    a(start_, cycle_, at_, before_, added_, removed_, table_, row_);
    if (a.reads()) stage_ = in_.stages[at_].input->make(experiment_);
    stage_->archive(a);
  }

 private:
  bool is_last() const { return cycle_ + 1 == in_.times && at_ + 1 == in_.stages.size(); }

  void open_stage(Simulation& sim) {
    before_ = sim.model;
    stage_ = in_.stages[at_].input->make(experiment_);
    stage_->open(sim);
  }

  void close_stage(Simulation& sim) {
    const std::string& name = in_.stages[at_].input->name;
    for (const Measure& m : measures_called(sim, in_.measures))
      add({name + "." + m.name, m.value(sim), m.dimension});
    for (const Result& r : stage_->close(sim)) {
      if (r.name == "added") added_ += r.value;
      if (r.name == "removed") removed_ += r.value;
      add({name + "." + r.name, r.value, r.dimension});
    }
    add({name + ".time", sim.state.time, Dimension::time});
    sim.restore(before_);
  }

  /// A number of the row in hand; the first row makes the columns.
  void add(const Result& r) {
    auto column = std::ranges::find(table_.columns, r.name, &Column::name);
    if (column == table_.columns.end()) {
      table_.columns.push_back({r.name, r.dimension});
      for (std::vector<double>& row : table_.rows) row.push_back(unknown);
      column = std::prev(table_.columns.end());
    }
    row_.resize(table_.columns.size(), unknown);
    row_[static_cast<std::size_t>(column - table_.columns.begin())] = r.value;
  }

  void next() {
    if (++at_ < in_.stages.size()) return;
    at_ = 0;
    row_.resize(table_.columns.size(), unknown);
    table_.rows.push_back(row_);
    row_ = {static_cast<double>(++cycle_ + 1)};
  }

  static constexpr double unknown = std::numeric_limits<double>::quiet_NaN();
  RepeatInput in_;
  CaseInput experiment_;
  double start_ = 0;                              // [s]
  int cycle_ = 0;                                 // how often all stages have run
  std::size_t at_ = 0;                            // the stage that runs
  std::unique_ptr<Stage> stage_;                  // made anew each time
  Conditions before_;                             // that stage
  double added_ = 0, removed_ = 0;                // stones
  ResultTable table_{"times", {{"number"}}, {}};  // a row each time
  std::vector<double> row_;                       // of the time in hand
};

std::unique_ptr<Stage> RepeatInput::make(const CaseInput& experiment) const {
  return std::make_unique<Repeat>(*this, experiment);
}

}  // namespace

Kind<StageInput> repeat_stage() {
  return kind_of<StageInput, RepeatInput>("repeat", "carries out a list of stages again and again");
}

}  // namespace trackbed
