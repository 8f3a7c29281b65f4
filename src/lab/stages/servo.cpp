#include "dem/servo.h"

#include <cmath>

#include "lab/checks.h"
#include "lab/stages/table.h"

namespace trackbed {
namespace {

struct ServoInput : StageInput {
  std::string wall;
  double force = 0;  // [N]
  Vec3 direction{0, 0, -1};
  double duration = 0;  // [s]
  void check(const Document& document, const CaseInput&, const Simulation& sim) const override {
    check_wall(document, sim, here + ".wall", wall);
    check_in_plane(document, sim, here + ".direction", direction);
  }
  void follow(const Document& document, Presence& presence) const override {
    presence.check(document, here + ".wall", wall);
  }
  std::unique_ptr<Stage> make(const CaseInput&) const override;
};

void declare(Fields& f, ServoInput& in) {
  declare_common(f, in);
  f.text(required("wall"), in.wall, "wall that presses");
  f.quantity(required("force"), in.force, Dimension::force, {.above = 0},
             "force that it exerts on the stones");
  f.vector("direction", in.direction, Dimension::none, {}, "in which it presses");
  f.quantity(required("duration"), in.duration, Dimension::time, {.above = 0}, "how long");
  f.check(in.direction.norm() > 0, "direction", "the direction is zero", "give a vector such as [0, 0, -1]");
  f.gives("force", Dimension::force, "that the stones bear in the end");
  f.gives("distance", Dimension::length, "that the wall has gone");
}

class Servo : public Stage {
 public:
  explicit Servo(const ServoInput& in) : in_(in) { in_.direction.normalize(); }

  void open(Simulation& sim) override {
    wall_ = sim.find_wall(in_.wall);
    end_ = sim.state.time + in_.duration;
    from_ = state(sim).pose.position;
  }
  void control(Simulation& sim) override {
    drive(sim, servo_speed(sim.model, sim.state, wall_, in_.direction, in_.force) * in_.direction);
  }
  bool finished(const Simulation& sim) override { return sim.state.time >= end_; }
  double remaining(const Simulation& sim) const override { return end_ - sim.state.time; }
  std::vector<Result> close(Simulation& sim) override {
    drive(sim, Vec3::Zero());
    return {{"force", -state(sim).force.dot(in_.direction), Dimension::force},
            {"distance", (state(sim).pose.position - from_).dot(in_.direction), Dimension::length}};
  }
  void archive(Archive& a) override { a(wall_, end_, from_); }

 private:
  void drive(Simulation& sim, const Vec3& velocity) const {
    sim.drive(static_cast<std::size_t>(wall_), velocity);
  }
  const WallState& state(const Simulation& sim) const {
    return sim.state.walls[static_cast<std::size_t>(wall_)];
  }
  ServoInput in_;
  int wall_ = 0;
  double end_ = 0;
  Vec3 from_ = Vec3::Zero();
};

std::unique_ptr<Stage> ServoInput::make(const CaseInput&) const {
  return std::make_unique<Servo>(*this);
}

}  // namespace

Kind<StageInput> servo_stage() {
  return kind_of<StageInput, ServoInput>("servo", "presses a wall against the stones with a force");
}

}  // namespace trackbed
