#include <algorithm>
#include <cmath>
#include <optional>
#include <tuple>
#include <utility>

#include "base/rng.h"
#include "lab/case.h"
#include "lab/in_touch.h"
#include "lab/room.h"
#include "lab/stages/parting.h"
#include "lab/stages/selection.h"
#include "lab/stages/table.h"

namespace trackbed {
namespace {

struct ReplaceInput : StageInput {
  std::string set;
  std::optional<std::string> from;
  Selection where;
  double share = 1;  // by mass
  std::optional<double> stiffness;
  double mean_overlap = 0.005;
  double time_limit = 1;  // [s]
  void check(const Document& document, const CaseInput& experiment, const Simulation& sim) const override {
    if (!set.empty()) check_stone_set(document, experiment, here + ".set", set);
    if (from && !from->empty()) check_stone_set(document, experiment, here + ".from", *from);
    where.check(document, experiment, here);
    if (from && *from == set)
      document.fail(here + ".from", "these stones are of the set already",
                    "name another one, or leave from out");
    if (stiffness && !is_softened(sim, sim.stone_set(set).material))
      document.fail(here + ".stiffness",
                    "a wall or body is of the stones' material, which would give way, too",
                    "give it a material of its own, or leave stiffness out");
  }
  std::unique_ptr<Stage> make(const CaseInput&) const override;
};

void declare(Fields& f, ReplaceInput& in) {
  declare_common(f, in);
  f.text("set", in.set, "a set of stones.sets whose shapes take over; by default those of [stones]");
  f.text("from", in.from,
         "only stones of this set of stones.sets are replaced, or, with \"\", of those of [stones]");
  declare_selection(f, in.where, "are replaced");
  f.number(
      "share", in.share, {.at_least = 0, .at_most = 1},
      "share by mass that the set then has of these stones, those that it has of them already counted; which "
      "are replaced is drawn at random");
  f.number("mean_overlap", in.mean_overlap, {.above = 0, .below = 1},
           "the stones are parted until the mean overlap is below this share of the smaller stone's radius");
  f.number(
      "stiffness", in.stiffness, {.above = 0, .at_most = 1},
      "share of their stiffness that stones have against each other while they part: low, they press none of "
      "themselves through a wall of triangles. By default 0.1; all of it where a wall is of their material");
  f.quantity("time_limit", in.time_limit, Dimension::time, {.above = 0},
             "the run fails when parting takes longer");
  f.gives("replaced", Dimension::none, "stones");
  f.gives("left", Dimension::none, "stones that had no room to be replaced");
  f.gives("share", Dimension::none, "replaced of all stones, by number");
  f.gives("mass_share", Dimension::none, "of the set, by mass of the selected stones");
  f.gives("time", Dimension::time, "that parting took");
  f.gives("mean_overlap", Dimension::none, "of touching stones, over the smaller one's radius");
  f.gives("largest_overlap", Dimension::none, "the same, the largest");
}

/// Puts stones of another set in the place of those there: equal volume, same centre, any orientation (PRRA,
/// docs/theory.md). Where the new shapes overlap they part.
class Replace : public Stage {
 public:
  explicit Replace(const ReplaceInput& in) : in_(in) {}

  void open(Simulation& sim) override {
    const StoneSet& set = sim.stone_set(in_.set);
    Rng rng(sim.seed, "replace " + in_.name);
    Clumps& c = sim.state.clumps;
    std::vector<Reshaped> stones;
    const std::vector<int> order = selected(sim);
    Mixture mixture;
    for (int clump : order) mixture.add(c.mass[static_cast<std::size_t>(clump)], is_of(sim, clump, set));
    for (int clump : order) {
      if (is_of(sim, clump, set)) continue;
      const auto k = static_cast<std::size_t>(clump);
      const double mass = mass_in(sim, set, k);
      if (!mixture.is_nearer_with(mass, c.mass[k], in_.share)) continue;
      const int shape = set.first + static_cast<int>(rng.index(static_cast<std::uint32_t>(set.count)));
      const Space& space = sim.model.space;
      const auto size = [&](int t) {
        return space.size_of_volume(sim.model.templates[static_cast<std::size_t>(t)].volume);
      };
      stones.push_back(
          {clump, shape, c.scale[k] * size(c.shape[k]) / size(shape), set.material, Quat::Identity()});
      if (find_orientation(sim, stones.back(), rng)) {
        mixture.take(mass, c.mass[k]);
        continue;
      }
      stones.pop_back();
      ++left_;
    }
    mass_share_ = mixture.now();
    reshape(sim.model, sim.state, stones);
    sim.stop_stones();
    replaced_ = static_cast<int>(stones.size());
    parting_.open(sim, in_.stiffness.value_or(0.1));
  }

  void control(Simulation& sim) override { parting_.control(sim); }
  bool finished(const Simulation& sim) override {
    return replaced_ == 0 || parting_.is_done(sim, in_.mean_overlap, in_.time_limit);
  }

  std::vector<Result> close(Simulation& sim) override {
    const double all = std::max(1, sim.state.clumps.size());
    return {{"replaced", static_cast<double>(replaced_), Dimension::none},
            {"left", static_cast<double>(left_), Dimension::none},
            {"share", replaced_ / all, Dimension::none},
            {"mass_share", mass_share_, Dimension::none},
            {"time", parting_.time(sim), Dimension::time},
            {"mean_overlap", parting_.overlaps().mean, Dimension::none},
            {"largest_overlap", parting_.overlaps().largest, Dimension::none}};
  }
  Awaited awaited(const Simulation&) const override { return parting_.awaited(in_.mean_overlap); }
  void archive(Archive& a) override { a(parting_, replaced_, left_, mass_share_); }

 private:
  /// Masses on the way to a mixture [kg].
  struct Mixture {
    double of_set = 0, kept = 0;

    void add(double mass, bool is_of_set) { (is_of_set ? of_set : kept) += mass; }
    double now() const { return of_set > 0 ? of_set / (of_set + kept) : 0.0; }
    void take(double mass, double instead_of) {
      of_set += mass;
      kept -= instead_of;
    }
    /// Whether one more brings the share by mass nearer to the one wanted.
    bool is_nearer_with(double mass, double instead_of, double wanted) const {
      if (wanted == 1) return true;
      Mixture next = *this;
      next.take(mass, instead_of);
      return std::abs(next.now() - wanted) < std::abs(now() - wanted);
    }
  };

  static bool is_of(const Simulation& sim, int clump, const StoneSet& set) {
    const int shape = sim.state.clumps.shape[static_cast<std::size_t>(clump)];
    return shape >= set.first && shape < set.first + set.count;
  }

  bool is_selected(const Simulation& sim, int clump) const {
    if (!in_.where.contains(sim, sim.state.clumps.position[static_cast<std::size_t>(clump)])) return false;
    return !in_.from || is_of(sim, clump, sim.stone_set(*in_.from));
  }

  /// All stones of the selection; at random where only a part is replaced.
  std::vector<int> selected(const Simulation& sim) const {
    std::vector<int> order;
    for (int clump = 0; clump < sim.state.clumps.size(); ++clump)
      if (is_selected(sim, clump)) order.push_back(clump);
    if (in_.share == 1) return order;
    Rng rng(sim.seed, "share " + in_.name);
    for (std::size_t k = order.size(); k > 1; --k)
      std::swap(order[k - 1], order[rng.index(static_cast<std::uint32_t>(k))]);
    return order;
  }

  /// Mass of a stone when it is one of the set [kg].
  static double mass_in(const Simulation& sim, const StoneSet& set, std::size_t clump) {
    return sim.model.materials[static_cast<std::size_t>(set.material)].density * volume_of(sim, clump);
  }

  /// Any orientation; beside walls one in which the stone keeps clear of all of them, or at least of those of
  /// triangles, if one of many tries does. A corner behind triangles would be pushed out on the other side,
  /// planes push it back. Returns whether there is such an orientation.
  static bool find_orientation(Simulation& sim, Reshaped& stone, Rng& rng) {
    constexpr int most_tries = 200;
    Clumps& c = sim.state.clumps;
    const auto k = static_cast<std::size_t>(stone.clump);
    const auto before = std::tuple(c.shape[k], c.scale[k], c.orientation[k]);
    c.shape[k] = stone.shape;
    c.scale[k] = stone.scale;
    bool is_clear = false, is_possible = false;
    for (int tries = 0; tries < most_tries && !is_clear; ++tries) {
      c.orientation[k] = sim.model.space.turn(rng);
      is_clear = is_clear_of_walls(sim, stone.clump, 0);
      if (!is_clear && (is_possible || !is_clear_of_walls(sim, stone.clump, 0, Walls::of_triangles)))
        continue;
      is_possible = true;
      stone.orientation = c.orientation[k];
    }
    std::tie(c.shape[k], c.scale[k], c.orientation[k]) = before;
    return is_possible;
  }

  ReplaceInput in_;
  Parting parting_;
  int replaced_ = 0;
  double mass_share_ = 0;
  int left_ = 0;  // that have no room to be replaced beside a wall
};

std::unique_ptr<Stage> ReplaceInput::make(const CaseInput&) const {
  return std::make_unique<Replace>(*this);
}

}  // namespace

Kind<StageInput> replace_stage() {
  return kind_of<StageInput, ReplaceInput>(
      "replace", "puts stones of another set in the place of those there, of the same volume");
}

}  // namespace trackbed
