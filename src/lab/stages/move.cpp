#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <optional>
#include <vector>

#include "lab/checks.h"
#include "lab/stages/conditions.h"
#include "lab/stages/levels.h"
#include "lab/stages/table.h"

namespace trackbed {
namespace {

struct MoveInput : StageInput {
  std::string wall;
  Vec3 velocity = Vec3::Zero();        // [m/s]
  std::optional<double> distance;      // [m]
  std::optional<double> displacement;  // [m]
  std::optional<double> duration;      // [s]
  std::optional<double> force;         // [N]
  std::vector<double> probes;          // [m]
  std::optional<double> mean_over;     // [m]
  ConditionsInput conditions;
  LevelsInput levels;
  bool says_when() const { return distance || displacement || duration || force; }
  void check(const Document& document, const CaseInput&, const Simulation& sim) const override;
  void follow(const Document& document, Presence& presence) const override {
    presence.check(document, here + ".wall", wall);
  }
  std::unique_ptr<Stage> make(const CaseInput&) const override;
};

std::string name_of_probe(double distance) {
  return fmt::format("force_at_{:g}_mm", 1e3 * distance);
}

void declare(Fields& f, MoveInput& in) {
  declare_common(f, in);
  f.text(required("wall"), in.wall, "wall that moves, or body, along axes in which it is not free");
  f.vector(required("velocity"), in.velocity, Dimension::velocity, {}, "its velocity");
  f.quantity("distance", in.distance, Dimension::length, {.above = 0}, "stop when it has gone this far");
  f.quantity("displacement", in.displacement, Dimension::length, {},
             "stop when its displacement along the velocity, from where it stood at the start of the run or "
             "was placed, is this or more");
  f.quantity("duration", in.duration, Dimension::time, {.above = 0}, "stop after this time");
  f.quantity("force", in.force, Dimension::force, {.above = 0},
             "stop when the stones push against the motion with this force");
  f.quantities("probes", in.probes, Dimension::length, {.above = 0},
               "distances at which the force against the motion is reported");
  f.quantity("mean_over", in.mean_over, Dimension::length, {.above = 0},
             "also report the largest of the force's means over parts of the way as long as that: single "
             "stones that jam count for less in it");
  declare(f, in.conditions);
  declare(f, in.levels);
  f.check(std::is_sorted(in.probes.begin(), in.probes.end()), "probes", "the distances do not ascend",
          "sort them");
  f.check(in.velocity.norm() > 0, "velocity", "the velocity is zero",
          "give a velocity, or use the stage hold");
  f.check(in.says_when() || in.levels.any(), "duration", "nothing says when the motion ends",
          "give distance, displacement, duration, force or levels");
  f.gives("distance", Dimension::length, "that it has gone");
  f.gives("force", Dimension::force, "against the motion, in the end");
  f.gives("force_peak", Dimension::force, "the largest on the way");
  f.gives("distance_at_peak", Dimension::length, "where that was");
  const bool has_means = in.mean_over.has_value();
  f.gives("mean_force_peak", Dimension::force, "with mean_over: the largest of the means", has_means);
  f.gives("distance_at_mean_peak", Dimension::length, "with mean_over: the middle of that part of the way",
          has_means);
  f.gives("force_at_NUMBER_mm", Dimension::force, "with probes: at each of them", false);
  for (const double probe : in.probes) f.gives(name_of_probe(probe), Dimension::force, "at this probe");
  declare_results(f, in.levels);
}

void MoveInput::check(const Document& document, const CaseInput&, const Simulation& sim) const {
  check_in_plane(document, sim, here + ".velocity", velocity);
  levels.check(document, sim, here);
  const int number = sim.find_wall(wall);
  const bool is_body = number >= 0 && sim.model.walls[static_cast<std::size_t>(number)].body;
  if (!is_body) return check_wall(document, sim, here + ".wall", wall);
  const BodyProperties& body = *sim.model.walls[static_cast<std::size_t>(number)].body;
  for (int a = 0; a < 3; ++a)
    if (velocity[a] != 0 && body.free_shift[static_cast<std::size_t>(a)])
      document.fail(here + ".velocity", fmt::format("{} is free to move along {}", wall, "xyz"[a]),
                    "leave that axis out of its `free`: a body is either driven along an axis or free");
}

/// The largest of a force's means over equal parts of a way. A part that the way ends in does not count.
class PeakOfMeans {
 public:
  void look(double force, double gone, double part) {
    sum_ += force;
    ++count_;
    if (gone < static_cast<double>(parts_ + 1) * part) return;
    if (const double mean = sum_ / count_; mean > peak_) {
      peak_ = mean;
      at_ = (static_cast<double>(parts_) + 0.5) * part;
    }
    sum_ = count_ = 0;
    while (gone >= static_cast<double>(parts_ + 1) * part) ++parts_;
  }
  double peak() const { return peak_; }
  double at() const { return at_; }
  template <class Archive>
  void archive(Archive& a) {
    a(sum_, count_, parts_, peak_, at_);
  }

 private:
  double sum_ = 0, count_ = 0;  // of the part that it is in
  std::int64_t parts_ = 0;      // behind
  double peak_ = 0, at_ = 0;    // [N], its middle [m]
};

class Move : public Stage {
 public:
  explicit Move(const MoveInput& in) : in_(in), direction_(in.velocity.normalized()), levels_(in.levels) {}

  void open(Simulation& sim) override {
    wall_ = static_cast<std::size_t>(sim.find_wall(in_.wall));
    start_ = sim.state.time;
    from_ = sim.state.walls[wall_].pose.position;
    apply(in_.conditions, sim);
    levels_.open(sim);
  }
  void control(Simulation& sim) override {
    look(sim);
    sim.drive(wall_, in_.velocity);
  }
  bool finished(const Simulation& sim) override {
    levels_.look(sim, resistance(sim), distance(sim));
    if (in_.distance && distance(sim) >= *in_.distance) return true;
    if (in_.displacement && displacement(sim) >= *in_.displacement) return true;
    if (in_.duration && sim.state.time - start_ >= *in_.duration) return true;
    if (in_.force && resistance(sim) >= *in_.force) return true;
    return !in_.says_when() && levels_.all_crossed();
  }
  std::vector<Result> close(Simulation& sim) override {
    look(sim);
    sim.drive(wall_, Vec3::Zero());
    std::vector<Result> results{{"distance", distance(sim), Dimension::length},
                                {"force", resistance(sim), Dimension::force},
                                {"force_peak", peak_, Dimension::force},
                                {"distance_at_peak", peak_at_, Dimension::length}};
    if (in_.mean_over) {
      results.push_back({"mean_force_peak", means_.peak(), Dimension::force});
      results.push_back({"distance_at_mean_peak", means_.at(), Dimension::length});
    }
    for (std::size_t k = 0; k < probed_.size(); ++k)
      results.push_back({name_of_probe(in_.probes[k]), probed_[k], Dimension::force});
    for (const Result& r : levels_.results()) results.push_back(r);
    return results;
  }
  const ResultTable* table() const override { return levels_.table(); }
  double remaining(const Simulation& sim) const override {
    double left = 0;
    if (in_.duration) left = start_ + *in_.duration - sim.state.time;
    if (in_.distance) left = std::max(left, (*in_.distance - distance(sim)) / in_.velocity.norm());
    if (in_.displacement)
      left = std::max(left, (*in_.displacement - displacement(sim)) / in_.velocity.norm());
    return left;
  }
  Awaited awaited(const Simulation& sim) const override {
    if (!in_.force) return {};
    return {"force", resistance(sim), *in_.force, Dimension::force};
  }
  void archive(Archive& a) override { a(wall_, start_, from_, peak_, peak_at_, means_, probed_, levels_); }

 private:
  double distance(const Simulation& sim) const {
    return direction_.dot(sim.state.walls[wall_].pose.position - from_);
  }
  double displacement(const Simulation& sim) const {
    return direction_.dot(sim.state.walls[wall_].pose.position - sim.wall_reference[wall_].position);
  }
  /// Force of the stones against the motion [N].
  double resistance(const Simulation& sim) const { return -sim.state.walls[wall_].force.dot(direction_); }

  void look(const Simulation& sim) {
    const double force = resistance(sim), gone = distance(sim);
    if (force > peak_) {
      peak_ = force;
      peak_at_ = gone;
    }
    if (in_.mean_over) means_.look(force, gone, *in_.mean_over);
    while (probed_.size() < in_.probes.size() && gone >= in_.probes[probed_.size()]) probed_.push_back(force);
  }

  MoveInput in_;
  Vec3 direction_;
  std::size_t wall_ = 0;
  double start_ = 0;
  Vec3 from_ = Vec3::Zero();
  double peak_ = 0, peak_at_ = 0;  // [N], [m]
  PeakOfMeans means_;
  std::vector<double> probed_;  // [N]
  Levels levels_;
};

std::unique_ptr<Stage> MoveInput::make(const CaseInput&) const {
  return std::make_unique<Move>(*this);
}

}  // namespace

Kind<StageInput> move_stage() {
  return kind_of<StageInput, MoveInput>("move", "moves a wall or body with a constant velocity");
}

}  // namespace trackbed
