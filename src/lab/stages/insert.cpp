#include <fmt/format.h>

#include <optional>

#include "base/error.h"
#include "dem/overlap.h"
#include "lab/checks.h"
#include "lab/measure.h"
#include "lab/stages/table.h"

namespace trackbed {
namespace {

struct InsertInput : StageInput {
  std::string body;
  double embedment = 0;          // [m]
  std::optional<double> bottom;  // [m]
  std::vector<double> at;        // [m]
  double clearance = 0;          // [m]
  bool held = false;
  void check(const Document& document, const CaseInput&, const Simulation& sim) const override {
    check_body(document, sim, here + ".body", body);
    if (!at.empty()) check_in_plane(document, sim, here + ".at", {at[0], at[1], 0});
  }
  void follow(const Document&, Presence& presence) const override { presence.put(body); }
  std::unique_ptr<Stage> make(const CaseInput&) const override;
};

void declare(Fields& f, InsertInput& in) {
  declare_common(f, in);
  f.text(required("body"), in.body, "body to place");
  f.quantity("embedment", in.embedment, Dimension::length, {},
             "depth of its lowest point below the surface of the bed around it");
  f.quantity("bottom", in.bottom, Dimension::length, {}, "height of its lowest point; instead of embedment");
  f.quantities("at", in.at, Dimension::length, {}, "x and y of its centre; by default the container's");
  f.quantity("clearance", in.clearance, Dimension::length, {.at_least = 0},
             "stones nearer than this are removed");
  f.flag("held", in.held, "it stays where it is, whatever acts on it, until the stage release");
  f.check(!in.bottom || in.embedment == 0, "bottom", "bottom and embedment say the same thing twice",
          "give one of them");
  f.check(in.at.empty() || in.at.size() == 2, "at", "two lengths are needed", "give x and y");
  f.gives("removed", Dimension::none, "stones in its way");
  f.gives("bed_surface", Dimension::length, "height of the bed around it");
  f.gives("bottom", Dimension::length, "height of its lowest point");
}

class Insert : public Stage {
 public:
  explicit Insert(const InsertInput& in) : in_(in) {}

  void open(Simulation& sim) override {
    const int body = sim.find_wall(in_.body);
    const auto b = static_cast<std::size_t>(body);
    const WallShape& shape = sim.model.walls[b].shape;
    WallState& wall = sim.state.walls[b];
    Eigen::AlignedBox3d box;
    for (const Vec3& v : shape.mesh.vertices) box.extend(wall.pose.orientation * v);

    Vec3 centre = sim.container.isEmpty() ? Vec3::Zero() : Vec3(sim.container.center());
    if (in_.at.size() == 2) centre = {in_.at[0], in_.at[1], 0};
    wall.pose.position = {centre.x(), centre.y(), 0};
    surface_ = 0;
    if (!in_.bottom) {
      const Vec3 low = wall.pose.position + box.min(), high = wall.pose.position + box.max();
      surface_ = bed_surface(sim, {Eigen::Vector2d(low.x(), low.y()), Eigen::Vector2d(high.x(), high.y())});
    }
    bottom_ = in_.bottom ? *in_.bottom : surface_ - in_.embedment;
    wall.pose.position.z() = bottom_ - box.min().z();
    wall.present = true;
    wall.held = in_.held;
    wall.velocity = wall.angular_velocity = wall.angular_momentum = Vec3::Zero();
    sim.wall_reference[b] = wall.pose;
    sim.model.domain.extend(wall.pose.position + box.max());

    std::vector<int> gone;
    for (int c = 0; c < sim.state.clumps.size(); ++c)
      if (is_in_the_way(sim, c, body)) gone.push_back(c);
    remove_clumps(sim.state, gone);
    removed_ = static_cast<int>(gone.size());
    sim.changed();
  }

  bool finished(const Simulation&) override { return true; }

  std::vector<Result> close(Simulation&) override {
    return {{"removed", static_cast<double>(removed_), Dimension::none},
            {"bed_surface", surface_, Dimension::length},
            {"bottom", bottom_, Dimension::length}};
  }
  void archive(Archive& a) override { a(removed_, surface_, bottom_); }

 private:
  bool is_in_the_way(const Simulation& sim, int stone, int body) const {
    if (stone_meets_wall(sim.model, sim.state, stone, body, in_.clearance)) return true;
    const auto k = static_cast<std::size_t>(stone);
    const WallState& wall = sim.state.walls[static_cast<std::size_t>(body)];
    return is_inside(sim.model.walls[static_cast<std::size_t>(body)].shape,
                     wall.pose.to_body(sim.state.clumps.position[k]));
  }

  InsertInput in_;
  int removed_ = 0;
  double surface_ = 0, bottom_ = 0;
};

std::unique_ptr<Stage> InsertInput::make(const CaseInput&) const {
  return std::make_unique<Insert>(*this);
}

}  // namespace

Kind<StageInput> insert_stage() {
  return kind_of<StageInput, InsertInput>("insert",
                                          "places a body on or in the bed and removes the stones in its way");
}

}  // namespace trackbed
