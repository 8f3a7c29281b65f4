#include "lab/stages/conditions.h"

namespace trackbed {

void declare(Fields& f, ConditionsInput& in) {
  f.number("friction", in.friction, {.at_least = 0, .at_most = 10},
           "upper bound on the friction of all contacts during this stage: low values make a denser bed");
  f.number("damping", in.damping, {.at_least = 0, .below = 1}, "local damping during this stage");
  f.flag(
      "scaled_step", in.scaled_step,
      "stones get more inertia, not weight, where this allows a longer time step: rest is reached in fewer "
      "steps, on another way; for motion so slow that its speed does not matter; not for stones that fall");
  f.number("scaled_share", in.scaled_share, {.above = 0, .at_most = 1},
           "share of the stones that scaled_step may give more inertia, those with the shortest steps of "
           "their own; "
           "more for wide gradings, whose many small stones keep the step short");
  f.check(in.scaled_step || in.scaled_share == usual_scaled_share, "scaled_share",
          "no stone has its inertia raised here", "set scaled_step = true, or leave it out");
}

void declare_scaled_share(Fields& f, double& share) {
  f.number(
      "scaled_share", share, {.above = 0, .at_most = 1},
      "share of the stones that get more inertia meanwhile, those with the shortest steps of their own; 1 "
      "for wide gradings: large stones move as quickly as small ones");
}

void apply(const ConditionsInput& in, Simulation& sim) {
  if (in.damping) sim.model.local_damping = *in.damping;
  if (in.friction) sim.model.pairs = sim.model.pairs.with_friction_up_to(*in.friction);
  if (in.scaled_step) sim.scale_step(in.scaled_share);
}

}  // namespace trackbed
