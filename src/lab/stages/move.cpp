#include <cmath>
#include <optional>

#include "lab/checks.h"
#include "lab/stages/table.h"

namespace trackbed {
namespace {

struct MoveInput : StageInput {
  std::string wall;
  Vec3 velocity = Vec3::Zero();    // [m/s]
  std::optional<double> distance;  // [m]
  std::optional<double> duration;  // [s]
  std::optional<double> force;     // [N]
  void check(const Document& document, const CaseInput&, const Simulation& sim) const override {
    check_wall(document, sim, here + ".wall", wall);
  }
  std::unique_ptr<Stage> make(const CaseInput&) const override;
};

void declare(Fields& f, MoveInput& in) {
  declare_common(f, in);
  f.text(required("wall"), in.wall, "wall that moves");
  f.vector(required("velocity"), in.velocity, Dimension::velocity, {}, "its velocity");
  f.quantity("distance", in.distance, Dimension::length, {.above = 0}, "stop when it has gone this far");
  f.quantity("duration", in.duration, Dimension::time, {.above = 0}, "stop after this time");
  f.quantity("force", in.force, Dimension::force, {.above = 0},
             "stop when the stones push against the motion with this force");
  f.check(in.velocity.norm() > 0, "velocity", "the velocity is zero",
          "give a velocity, or use the stage hold");
  f.check(in.distance || in.duration || in.force, "duration", "nothing says when the motion ends",
          "give distance, duration or force");
}

class Move : public Stage {
 public:
  explicit Move(const MoveInput& in) : in_(in) {}

  void open(Simulation& sim) override {
    wall_ = static_cast<std::size_t>(sim.find_wall(in_.wall));
    start_ = sim.state.time;
    from_ = sim.state.walls[wall_].pose.position;
  }
  void control(Simulation& sim) override { sim.state.walls[wall_].velocity = in_.velocity; }
  bool finished(const Simulation& sim) override {
    const WallState& wall = sim.state.walls[wall_];
    if (in_.distance && (wall.pose.position - from_).norm() >= *in_.distance) return true;
    if (in_.duration && sim.state.time - start_ >= *in_.duration) return true;
    return in_.force && -wall.force.dot(in_.velocity.normalized()) >= *in_.force;
  }
  std::vector<Result> close(Simulation& sim) override {
    WallState& wall = sim.state.walls[wall_];
    wall.velocity = Vec3::Zero();
    return {{"distance", (wall.pose.position - from_).norm(), Dimension::length},
            {"force", -wall.force.dot(in_.velocity.normalized()), Dimension::force}};
  }
  double remaining(const Simulation& sim) const override {
    double left = 0;
    if (in_.duration) left = start_ + *in_.duration - sim.state.time;
    if (in_.distance)
      left = std::max(left, (*in_.distance - (sim.state.walls[wall_].pose.position - from_).norm()) /
                                in_.velocity.norm());
    return left;
  }

 private:
  MoveInput in_;
  std::size_t wall_ = 0;
  double start_ = 0;
  Vec3 from_ = Vec3::Zero();
};

std::unique_ptr<Stage> MoveInput::make(const CaseInput&) const {
  return std::make_unique<Move>(*this);
}

}  // namespace

Kind<StageInput> move_stage() {
  return kind_of<StageInput, MoveInput>("move", "moves a wall with a constant velocity");
}

}  // namespace trackbed
