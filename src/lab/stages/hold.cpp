#include <cmath>

#include "lab/stages/table.h"

namespace trackbed {
namespace {

struct HoldInput : StageInput {
  double duration = 0;  // [s]
  std::unique_ptr<Stage> make(const CaseInput&) const override;
};

void declare(Fields& f, HoldInput& in) {
  declare_common(f, in);
  f.quantity(required("duration"), in.duration, Dimension::time, {.above = 0}, "simulated time to let pass");
}

class Hold : public Stage {
 public:
  explicit Hold(const HoldInput& in) : in_(in) {}
  void open(Simulation& sim) override { end_ = sim.state.time + in_.duration; }
  bool finished(const Simulation& sim) override { return sim.state.time >= end_; }
  double remaining(const Simulation& sim) const override { return end_ - sim.state.time; }
  void archive(Archive& a) override { a(end_); }

 private:
  HoldInput in_;
  double end_ = 0;
};

std::unique_ptr<Stage> HoldInput::make(const CaseInput&) const {
  return std::make_unique<Hold>(*this);
}

}  // namespace

Kind<StageInput> hold_stage() {
  return kind_of<StageInput, HoldInput>("hold", "lets time pass");
}

}  // namespace trackbed
