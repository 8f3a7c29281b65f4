#include <algorithm>

#include "lab/case.h"
#include "lab/stages/selection.h"
#include "lab/stages/table.h"

namespace trackbed {
namespace {

struct RemoveInput : StageInput {
  std::vector<std::string> walls;
  Selection where;
  void check(const Document& document, const CaseInput& experiment, const Simulation& sim) const override {
    for (const std::string& wall : walls) check_wall(document, sim, here + ".walls", wall);
    where.check(document, experiment, here);
  }
  void follow(const Document& document, Presence& presence) const override {
    for (const std::string& wall : walls) {
      presence.check(document, here + ".walls", wall);
      presence.take_away(wall);
    }
  }
  std::unique_ptr<Stage> make(const CaseInput&) const override;
};

void declare(Fields& f, RemoveInput& in) {
  declare_common(f, in);
  f.texts("walls", in.walls, "walls that are taken away, such as the forms and the lid of a bed");
  declare_selection(f, in.where, "are taken away", "none");
  f.check(!in.walls.empty() || !in.where.is_all(), "walls", "there is nothing to take away",
          "name walls, or a region");
  f.gives("removed", Dimension::none, "stones");
}

class Remove : public Stage {
 public:
  explicit Remove(const RemoveInput& in) : in_(in) {}

  void open(Simulation& sim) override {
    for (const std::string& name : in_.walls) {
      WallState& wall = sim.state.walls[static_cast<std::size_t>(sim.find_wall(name))];
      wall.present = false;
      wall.velocity = wall.angular_velocity = wall.force = wall.moment = Vec3::Zero();
    }
    std::vector<int> gone;
    for (int c = 0; !in_.where.is_all() && c < sim.state.clumps.size(); ++c)
      if (in_.where.contains(sim, sim.state.clumps.position[static_cast<std::size_t>(c)])) gone.push_back(c);
    remove_clumps(sim.state, gone);
    removed_ = static_cast<int>(gone.size());
    sim.changed();
  }

  bool finished(const Simulation&) override { return true; }

  std::vector<Result> close(Simulation&) override {
    return {{"removed", static_cast<double>(removed_), Dimension::none}};
  }
  void archive(Archive& a) override { a(removed_); }

 private:
  RemoveInput in_;
  int removed_ = 0;
};

std::unique_ptr<Stage> RemoveInput::make(const CaseInput&) const {
  return std::make_unique<Remove>(*this);
}

}  // namespace

Kind<StageInput> remove_stage() {
  return kind_of<StageInput, RemoveInput>("remove", "takes away walls, or the stones of a region");
}

}  // namespace trackbed
