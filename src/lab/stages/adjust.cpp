#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "base/error.h"
#include "lab/case.h"
#include "lab/measures/measures.h"
#include "lab/room.h"
#include "lab/stages/conditions.h"
#include "lab/stages/table.h"

namespace trackbed {
namespace {

struct AdjustInput : StageInput {
  std::optional<double> stress;  // [Pa]
  std::optional<double> tolerance;
  double unbalanced_ratio = 1e-3;
  double largest_factor = 0.01;
  int steps = 400, rounds = 200;
  double scaled_share = usual_scaled_share;
  std::optional<double> friction;  // during this stage
  void check(const Document& document, const CaseInput&, const Simulation& sim) const override {
    check_room(document, here, sim);
  }
  std::unique_ptr<Stage> make(const CaseInput&) const override;
};

void declare(Fields& f, AdjustInput& in) {
  declare_common(f, in);
  f.quantity(
      "stress", in.stress, Dimension::stress, {.above = 0},
      "mean stress to reach; by default sizes are only reduced, until it is no more than the bed's weight "
      "brings about with K0 = 0.4");
  f.number("tolerance", in.tolerance, {.above = 0},
           "of the mean stress; by default 5 %, or 50 % when no stress is given, for K0 depends on the bed");
  f.number("unbalanced_ratio", in.unbalanced_ratio, {.above = 0, .below = 1},
           "the bed must be as near to rest as that");
  f.number("largest_factor", in.largest_factor, {.above = 0, .below = 0.5},
           "the run fails when sizes would have to change by more than this share in all");
  f.integer("steps", in.steps, {.at_least = 50}, "between two changes of the sizes");
  f.integer("rounds", in.rounds, {.at_least = 1}, "most changes of the sizes");
  declare_scaled_share(f, in.scaled_share);
  f.number("friction", in.friction, {.at_least = 0, .at_most = 10},
           "upper bound on the friction of all contacts during this stage");
  f.gives("factor", Dimension::none, "on all sizes in the end");
  f.gives("rounds", Dimension::none, "changes of the sizes");
  f.gives("stress", Dimension::stress, "mean stress of the bed in the end");
  f.gives("stress_wanted", Dimension::stress, "what it was adjusted to");
  f.gives("porosity", Dimension::none, "as the measure of this name");
  f.gives("largest_overlap", Dimension::none, "as the measure of this name");
}

/// Shrinks or grows all stones, with a scaled time step, about their centres until the mean stress is that
/// asked for (PRRA; eq. in docs/theory.md).
class Adjust : public Stage {
 public:
  explicit Adjust(const AdjustInput& in) : in_(in) {}

  void open(Simulation& sim) override {
    if (in_.friction) sim.model.pairs = sim.model.pairs.with_friction_up_to(*in_.friction);
    target_ = in_.stress ? *in_.stress : stress_of_weight(sim);
    start_ = next_ = sim.state.step;
    sim.scale_step(in_.scaled_share);
    sim.changed();
  }

  void control(Simulation& sim) override {
    constexpr int calm_rounds = 5, calm_every = 50;
    if (sim.state.step < start_ + calm_rounds * in_.steps && sim.state.step % calm_every == 0)
      sim.stop_stones();
    if (sim.state.step < next_) return;
    next_ = sim.state.step + in_.steps;
    const BedStress now = bed_stress(sim);
    const double excess = now.mean - target_;
    // Stones that lie too loose come nearer by themselves: only a stress of the user's own makes them grow.
    reached_ = (in_.stress ? std::abs(excess) : excess) <= tolerance() * target_;
    if (!reached_) awaited_ = {"mean stress", now.mean, target_, Dimension::stress};
    if (reached_ || now.stiffness == 0) return;
    if (round_ == in_.rounds) fail(now, fmt::format("after {} changes of the sizes", round_));
    change_sizes(sim, now);
  }

  bool finished(const Simulation& sim) override {
    constexpr int look_every = 50;  // it looks at all contacts
    if (!reached_ || (sim.state.step - start_) % look_every != 0) return false;
    const double ratio = unbalanced_ratio(sim.model, sim.state);
    awaited_ = {"unbalanced ratio", ratio, in_.unbalanced_ratio};
    return ratio < in_.unbalanced_ratio;
  }

  std::vector<Result> close(Simulation& sim) override {
    const BedStress now = bed_stress(sim);
    return {{"factor", factor_, Dimension::none},
            {"rounds", static_cast<double>(round_), Dimension::none},
            {"stress", now.mean, Dimension::stress},
            {"stress_wanted", target_, Dimension::stress},
            {"porosity", porosity(sim, solid_volume(sim)), Dimension::none},
            {"largest_overlap", largest_overlap(sim), Dimension::none}};
  }
  Awaited awaited(const Simulation&) const override { return awaited_; }
  void archive(Archive& a) override { a(target_, factor_, round_, start_, next_, reached_); }

 private:
  double tolerance() const { return in_.tolerance.value_or(in_.stress ? 0.05 : 0.5); }

  /// Half of the floor's pressure, for the mean over the height, and the sides' share with K0 = 0.4 [Pa].
  static double stress_of_weight(const Simulation& sim) {
    constexpr double k0 = 0.4;
    const Vec3 size = sim.container.sizes();
    const int n = sim.model.space.dimensions();
    return (1.0 + (n - 1) * k0) / n * 0.5 * weight(sim) / (size.x() * size.y());
  }

  void change_sizes(Simulation& sim, const BedStress& now) {
    constexpr double relaxation = 0.5, most_growth = 1e-3, most_loss = 2e-3;
    const double beta = std::clamp(
        relaxation * sim.model.space.dimensions() * now.volume * (target_ - now.mean) / now.stiffness,
        -most_loss, most_growth);
    if (std::abs(factor_ * (1.0 + beta) - 1.0) > in_.largest_factor)
      fail(now, fmt::format("with sizes changed by {:+.2f} %", 100 * (factor_ - 1.0)));
    factor_ *= 1.0 + beta;
    for (int c = 0; c < sim.state.clumps.size(); ++c) rescale(sim.model, sim.state, c, 1.0 + beta);
    ++round_;
    sim.changed();
  }

  [[noreturn]] void fail(const BedStress& now, const std::string& when) const {
    throw RunError(
        fmt::format("the mean stress is {:.3g} Pa {}, {:.3g} Pa was to be reached: these shapes do "
                    "not reach this porosity; raise it, or allow a larger largest_factor",
                    now.mean, when, target_));
  }

  AdjustInput in_;
  double target_ = 0, factor_ = 1;
  int round_ = 0;
  std::int64_t start_ = 0, next_ = 0;
  bool reached_ = false;
  Awaited awaited_;  // as last looked at
};

std::unique_ptr<Stage> AdjustInput::make(const CaseInput&) const {
  return std::make_unique<Adjust>(*this);
}

}  // namespace

Kind<StageInput> adjust_stage() {
  return kind_of<StageInput, AdjustInput>(
      "adjust", "changes the sizes of all stones a little until the bed bears the stress it should");
}

}  // namespace trackbed
