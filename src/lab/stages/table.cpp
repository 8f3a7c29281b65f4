#include "lab/stages/table.h"

#include <fmt/format.h>

#include "base/error.h"

namespace trackbed {

const Kinds<StageInput>& stage_kinds() {
  static const Kinds<StageInput> kinds{"stage",
                                       {fill_stage(), settle_stage(), insert_stage(), load_stage(), move_stage(),
                                        servo_stage(), hold_stage()}};
  return kinds;
}

void declare_common(Fields& f, StageInput& in) {
  in.here = f.here();
  f.text("name", in.name, "name of the stage in the results; by default its kind");
}

int wall_of(const Simulation& sim, const StageInput& in, const std::string& wall, bool must_be_body) {
  const int w = sim.find_wall(wall);
  if (w >= 0 && sim.model.walls[static_cast<std::size_t>(w)].body.has_value() == must_be_body) return w;
  std::string known;
  for (const Wall& other : sim.model.walls)
    if (other.body.has_value() == must_be_body) known += (known.empty() ? "" : ", ") + other.shape.name;
  throw InputError(fmt::format("stage {}: there is no {} called {}; there is: {}", in.name,
                               must_be_body ? "body" : "wall", wall, known.empty() ? "none" : known));
}

}  // namespace trackbed
