#include <fmt/format.h>

#include <algorithm>
#include <optional>

#include "base/error.h"
#include "lab/case.h"
#include "lab/stages/conditions.h"
#include "lab/stages/table.h"

namespace trackbed {
namespace {

struct SettleInput : StageInput {
  double unbalanced_ratio = 1e-3;
  double time_limit = 10;         // [s]
  std::optional<double> gravity;  // during this stage [m/s^2]
  ConditionsInput conditions;
  void check(const Document& document, const CaseInput& experiment, const Simulation&) const override {
    if (gravity && experiment.numerics.gravity.isZero(0))
      document.fail(here + ".gravity", "there is no gravity to raise: its direction is not known",
                    "give numerics.gravity a direction");
  }
  std::unique_ptr<Stage> make(const CaseInput&) const override;
};

void declare(Fields& f, SettleInput& in) {
  declare_common(f, in);
  f.number("unbalanced_ratio", in.unbalanced_ratio, {.above = 0, .below = 1},
           "at rest when the sum of unbalanced forces is below this share of the sum of all forces");
  f.quantity("time_limit", in.time_limit, Dimension::time, {.above = 0},
             "the run fails when rest takes longer");
  f.quantity("gravity", in.gravity, Dimension::acceleration, {.above = 0},
             "raised gravity during this stage, in its usual direction: stones fall and pack faster");
  declare(f, in.conditions);
  f.gives("time", Dimension::time, "until rest");
  f.gives("unbalanced_ratio", Dimension::none, "in the end");
}

class Settle : public Stage {
 public:
  explicit Settle(const SettleInput& in) : in_(in) {}

  void open(Simulation& sim) override {
    start_ = sim.state.time;
    Model& m = sim.model;
    if (in_.gravity) m.gravity = *in_.gravity * m.gravity.normalized();
    apply(in_.conditions, sim);
  }

  bool finished(const Simulation& sim) override {
    if (sim.state.step % look_every != 0 || sim.state.clumps.size() == 0) return sim.state.clumps.size() == 0;
    // Stones that pass through their rest position are for a moment without acceleration, but not at rest:
    // the ratio must stay low.
    const double ratio = unbalanced_ratio(sim.model, sim.state);
    awaited_ = {"unbalanced ratio", ratio, in_.unbalanced_ratio};
    calm_ = ratio < in_.unbalanced_ratio ? calm_ + 1 : 0;
    if (calm_ >= looks_needed) return true;
    if (sim.state.time - start_ > in_.time_limit)
      throw RunError(
          fmt::format("not at rest after {:.3g} s: the unbalanced ratio is {:.2e}, {:.2e} was asked for",
                      in_.time_limit, ratio, in_.unbalanced_ratio));
    return false;
  }

  std::vector<Result> close(Simulation& sim) override {
    const double ratio = unbalanced_ratio(sim.model, sim.state);
    return {{"time", sim.state.time - start_, Dimension::time}, {"unbalanced_ratio", ratio, Dimension::none}};
  }
  Awaited awaited(const Simulation&) const override { return awaited_; }
  void archive(Archive& a) override { a(start_, calm_); }

 private:
  static constexpr int look_every = 50, looks_needed = 5;
  SettleInput in_;
  double start_ = 0;
  int calm_ = 0;
  Awaited awaited_;  // as last looked at
};

std::unique_ptr<Stage> SettleInput::make(const CaseInput&) const {
  return std::make_unique<Settle>(*this);
}

}  // namespace

Kind<StageInput> settle_stage() {
  return kind_of<StageInput, SettleInput>("settle", "lets the stones come to rest under gravity");
}

}  // namespace trackbed
