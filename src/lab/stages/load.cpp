#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>

#include "lab/checks.h"
#include "lab/stages/table.h"

namespace trackbed {
namespace {

struct LoadInput : StageInput {
  std::string body;
  std::string waveform = "constant";
  double force_min = 0;             // [N]
  std::optional<double> force_max;  // [N]
  std::optional<double> frequency;  // [Hz]
  double duration = 0;              // [s]
  double ramp = 0;                  // [s]
  Vec3 direction{0, 0, -1};
  std::vector<double> times, forces;  // [s], [N]
  void check(const Document& document, const CaseInput&, const Simulation& sim) const override {
    check_body(document, sim, here + ".body", body);
    check_in_plane(document, sim, here + ".direction", direction);
  }
  void follow(const Document& document, Presence& presence) const override {
    presence.check(document, here + ".body", body);
  }
  std::unique_ptr<Stage> make(const CaseInput&) const override;

  bool is_periodic() const { return waveform == "sine" || waveform == "haversine"; }
  bool is_table() const { return waveform == "table"; }
};

void declare(Fields& f, LoadInput& in) {
  declare_common(f, in);
  f.text(required("body"), in.body, "body that is loaded");
  f.choice("waveform", in.waveform, {"constant", "sine", "haversine", "table"},
           "constant: force_max; sine: starts at the mean, rising; haversine: starts at force_min; table: "
           "times and "
           "forces, straight between them");
  f.quantity("force_min", in.force_min, Dimension::force, {}, "least force of a wave");
  f.quantity("force_max", in.force_max, Dimension::force, {}, "largest force of a wave, or the constant one");
  f.quantity("frequency", in.frequency, Dimension::frequency, {.above = 0}, "of a wave");
  f.quantity(required("duration"), in.duration, Dimension::time, {.above = 0}, "how long");
  f.quantity("ramp", in.ramp, Dimension::time, {.at_least = 0},
             "the force grows smoothly from its value before the stage over this time");
  f.vector("direction", in.direction, Dimension::none, {}, "in which the force acts");
  f.quantities("times", in.times, Dimension::time, {.at_least = 0}, "of a table, ascending");
  f.quantities("forces", in.forces, Dimension::force, {}, "of a table");
  f.check(in.direction.norm() > 0, "direction", "the direction is zero", "give a vector such as [0, 0, -1]");
  f.check(!in.is_periodic() || in.frequency, "frequency", "a wave needs a frequency",
          "give frequency, for example \"5 Hz\"");
  f.check(in.is_periodic() || (!in.frequency && in.force_min == 0), "waveform",
          "frequency and force_min belong to a wave",
          "choose the waveform sine or haversine, or leave them out");
  f.check(in.is_table() || in.force_max, "force_max", "there is no force",
          "give force_max, for example \"10 kN\"");
  f.check(!in.is_periodic() || in.force_min <= in.force_max, "force_max", "force_max is below force_min",
          "give the larger force as force_max");
  f.check(in.is_table() || (in.times.empty() && in.forces.empty()), "waveform",
          "times and forces belong to a table", "choose the waveform table, or leave them out");
  f.check(!in.is_table() || !in.force_max, "force_max", "the forces are those of the table",
          "leave force_max out, or choose another waveform");
  f.check(!in.is_table() || (in.times.size() == in.forces.size() && in.times.size() >= 2), "times",
          "a table needs as many times as forces, two at least", "give times and forces of equal length");
  f.check(std::is_sorted(in.times.begin(), in.times.end()), "times", "times must ascend",
          "sort the table by time");
  f.gives("displacement", Dimension::length, "of the body in the direction of the force");
  f.gives("displacement_last_half_cycle", Dimension::length, "of a wave: since half a cycle before the end",
          in.is_periodic());
  f.gives("energy_in", Dimension::energy, "work of force, walls and gravity meanwhile");
  f.gives("energy_error", Dimension::none, "what the balance of energies is out by, over energy_in");
}

class Load : public Stage {
 public:
  explicit Load(const LoadInput& in) : in_(in) { in_.direction.normalize(); }

  void open(Simulation& sim) override {
    body_ = static_cast<std::size_t>(sim.find_wall(in_.body));
    start_ = sim.state.time;
    before_ = sim.state.walls[body_].applied_force;
    from_ = half_cycle_from_ = height(sim);
    energy_ = energy_of(sim.model, sim.state);
  }

  void control(Simulation& sim) override {
    // The force belongs to the start of the step, where it is applied.
    const double t = sim.state.time - start_;
    sim.state.walls[body_].applied_force = force_at(t) * in_.direction;
    if (in_.ramp > 0 && t < in_.ramp) {
      const double s = t / in_.ramp, grown = s * s * (3.0 - 2.0 * s);
      Vec3& force = sim.state.walls[body_].applied_force;
      force = before_ + grown * (force - before_);
    }
    if (in_.is_periodic() && t < in_.duration - 0.5 / *in_.frequency) half_cycle_from_ = height(sim);
  }

  bool finished(const Simulation& sim) override { return sim.state.time - start_ >= in_.duration; }
  double remaining(const Simulation& sim) const override { return start_ + in_.duration - sim.state.time; }

  std::vector<Result> close(Simulation& sim) override {
    const EnergyBalance now = energy_of(sim.model, sim.state);
    const double put_in = now.applied_work + now.boundary_work + energy_.potential - energy_.applied_work -
                          energy_.boundary_work - now.potential;
    std::vector<Result> results{{"displacement", height(sim) - from_, Dimension::length},
                                {"energy_in", put_in, Dimension::energy},
                                {"energy_error", (now.total() - energy_.total()) / put_in, Dimension::none}};
    if (in_.is_periodic())
      results.push_back({"displacement_last_half_cycle", height(sim) - half_cycle_from_, Dimension::length});
    return results;
  }
  void archive(Archive& a) override { a(body_, start_, from_, half_cycle_from_, before_, energy_); }

 private:
  double height(const Simulation& sim) const {
    return sim.state.walls[body_].pose.position.dot(in_.direction);
  }

  double force_at(double t) const {
    if (in_.waveform == "constant") return *in_.force_max;
    if (in_.is_periodic()) {
      const double phase = 2.0 * std::numbers::pi * *in_.frequency * t;
      const double half_range = 0.5 * (*in_.force_max - in_.force_min);
      const double wave = in_.waveform == "sine" ? std::sin(phase) : -std::cos(phase);
      return in_.force_min + half_range * (1.0 + wave);
    }
    if (t <= in_.times.front()) return in_.forces.front();
    for (std::size_t k = 1; k < in_.times.size(); ++k)
      if (t <= in_.times[k])
        return std::lerp(in_.forces[k - 1], in_.forces[k],
                         (t - in_.times[k - 1]) / (in_.times[k] - in_.times[k - 1]));
    return in_.forces.back();
  }

  LoadInput in_;
  std::size_t body_ = 0;
  double start_ = 0, from_ = 0, half_cycle_from_ = 0;
  Vec3 before_ = Vec3::Zero();
  EnergyBalance energy_;
};

std::unique_ptr<Stage> LoadInput::make(const CaseInput&) const {
  return std::make_unique<Load>(*this);
}

}  // namespace

Kind<StageInput> load_stage() {
  return kind_of<StageInput, LoadInput>("load", "applies a force that changes with time to a body");
}

}  // namespace trackbed
