#include "lab/checks.h"
#include "lab/stages/table.h"

namespace trackbed {
namespace {

struct ReleaseInput : StageInput {
  std::string body;
  void check(const Document& document, const CaseInput&, const Simulation& sim) const override {
    check_body(document, sim, here + ".body", body);
  }
  void follow(const Document& document, Presence& presence) const override {
    presence.check(document, here + ".body", body);
  }
  std::unique_ptr<Stage> make(const CaseInput&) const override;
};

void declare(Fields& f, ReleaseInput& in) {
  declare_common(f, in);
  f.text(required("body"), in.body, "body that was placed as held");
}

class Release : public Stage {
 public:
  explicit Release(const ReleaseInput& in) : in_(in) {}
  void open(Simulation& sim) override {
    const auto body = static_cast<std::size_t>(sim.find_wall(in_.body));
    sim.drive(body, Vec3::Zero());
    sim.state.walls[body].held = false;
  }
  bool finished(const Simulation&) override { return true; }
  void archive(Archive&) override {}

 private:
  ReleaseInput in_;
};

std::unique_ptr<Stage> ReleaseInput::make(const CaseInput&) const {
  return std::make_unique<Release>(*this);
}

}  // namespace

Kind<StageInput> release_stage() {
  return kind_of<StageInput, ReleaseInput>("release",
                                           "lets a held body go: from now on it moves where it is free to");
}

}  // namespace trackbed
