#include <fmt/format.h>

#include "base/error.h"
#include "base/rng.h"
#include "lab/case.h"
#include "lab/grading.h"
#include "lab/room.h"
#include "lab/stages/conditions.h"
#include "lab/stages/parting.h"
#include "lab/stages/selection.h"
#include "lab/stages/table.h"

namespace trackbed {
namespace {

struct ScatterInput : StageInput {
  double porosity = 0.4;
  std::string set;  // empty: that of [stones]
  Selection where;
  double mean_overlap = 0.01;
  double time_limit = 1;  // [s]
  double scaled_share = usual_scaled_share;
  bool is_room(const Simulation& sim, const Vec3& point) const {
    return where.contains(sim, point) && is_in_room(sim, point);
  }
  /// Random numbers are those of the stage; but an empty container as a whole has the same stones however it
  /// is filled.
  Rng numbers(const Simulation& sim, const std::string& what) const {
    const bool is_first = where.is_all() && sim.state.clumps.size() == 0;
    return {sim.seed, is_first ? what : what + " " + name};
  }
  std::vector<double> sizes(const CaseInput& experiment, const Simulation& sim) const {
    Rng rng = numbers(sim, "sizes");
    const double room = volume_in(
        container_now(sim), [&](const Vec3& point) { return is_room(sim, point); }, sim.model.space);
    return draw_sizes(experiment.stones.grading, sim.model.space, (1.0 - porosity) * room, rng);
  }
  void check(const Document& document, const CaseInput& experiment, const Simulation& sim) const override {
    if (!set.empty()) check_stone_set(document, experiment, here + ".set", set);
    check_room(document, here, sim);
    where.check(document, experiment, here);
    if (where.is_all() && sizes(experiment, sim).empty())
      document.fail(here + ".porosity", "no stone is left: the container is too small for the grading",
                    "make the container larger, the porosity lower or the stones smaller");
  }
  std::unique_ptr<Stage> make(const CaseInput&) const override;
};

void declare(Fields& f, ScatterInput& in) {
  declare_common(f, in);
  f.number("porosity", in.porosity, {.above = 0, .below = 1},
           "nominal: the stones' volume is (1 - porosity) x the free volume of the container");
  f.text("set", in.set, "a set of stones.sets to take the stones from; by default those of [stones]");
  declare_selection(f, in.where, "are placed");
  f.number("mean_overlap", in.mean_overlap, {.above = 0, .below = 1},
           "the stones are parted until the mean overlap is below this share of the smaller stone's radius");
  f.quantity("time_limit", in.time_limit, Dimension::time, {.above = 0},
             "the run fails when parting takes longer");
  declare_scaled_share(f, in.scaled_share);
  f.gives("added", Dimension::none, "stones");
  f.gives("time", Dimension::time, "that parting took");
  f.gives("mean_overlap", Dimension::none, "of touching stones, over the smaller one's radius");
  declare_passing(f);
}

/// Places stones anywhere in the container, overlapping each other but no wall, and lets them part: without
/// friction and gravity, and with damping that takes nearly all that the overlaps set free.
class Scatter : public Stage {
 public:
  Scatter(const ScatterInput& in, const CaseInput& experiment) : in_(in), experiment_(experiment) {}

  void open(Simulation& sim) override {
    sizes_ = in_.sizes(experiment_, sim);
    Rng rng = in_.numbers(sim, "places");  // before the first stone is there
    const StoneSet set = sim.stone_set(in_.set);
    for (double size : sizes_) place(sim, set, size, rng);
    parting_.open(sim, 1, in_.scaled_share);
  }

  void control(Simulation& sim) override { parting_.control(sim); }
  bool finished(const Simulation& sim) override {
    return parting_.is_done(sim, in_.mean_overlap, in_.time_limit);
  }

  std::vector<Result> close(Simulation& sim) override {
    std::vector<Result> results{{"added", static_cast<double>(sizes_.size()), Dimension::none},
                                {"time", parting_.time(sim), Dimension::time},
                                {"mean_overlap", parting_.overlaps().mean, Dimension::none}};
    for (const Result& r : passing_results(experiment_.stones.grading, sim.model.space, sizes_))
      results.push_back(r);
    return results;
  }
  Awaited awaited(const Simulation&) const override { return parting_.awaited(in_.mean_overlap); }
  void archive(Archive& a) override { a(sizes_, parting_); }

 private:
  void place(Simulation& sim, const StoneSet& set, double size, Rng& rng) const {
    const int shape = set.first + static_cast<int>(rng.index(static_cast<std::uint32_t>(set.count)));
    const double scale = scale_to_size(experiment_.stones.grading, sim.model.space,
                                       sim.model.templates[static_cast<std::size_t>(shape)], size);
    const int stone = add_clump(sim.model, sim.state, shape, scale, set.material, {});
    const auto k = static_cast<std::size_t>(stone);
    for (int tries = 0; tries < 10'000; ++tries) {
      sim.state.clumps.position[k] = sim.model.space.nearest(
          point_in(container_now(sim), rng, [&](const Vec3& point) { return in_.is_room(sim, point); }));
      sim.state.clumps.orientation[k] = sim.model.space.turn(rng);
      if (is_clear_of_walls(sim, stone, 0)) return;
    }
    throw InputError(
        fmt::format("stage {}: a stone of {:.1f} mm does not fit into the container", in_.name, 1e3 * size));
  }

  ScatterInput in_;
  CaseInput experiment_;
  std::vector<double> sizes_;  // [m]
  Parting parting_;
};

std::unique_ptr<Stage> ScatterInput::make(const CaseInput& experiment) const {
  return std::make_unique<Scatter>(*this, experiment);
}

}  // namespace

Kind<StageInput> scatter_stage() {
  return kind_of<StageInput, ScatterInput>(
      "scatter", "places stones anywhere in the container, by grading and porosity, and parts them");
}

}  // namespace trackbed
