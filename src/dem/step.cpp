#include "dem/step.h"

#include <chrono>
#include <cmath>

#include "base/error.h"
#include "dem/forces.h"
#include "dem/inspect.h"
#include "dem/motion.h"
#include "dem/search.h"
#include "dem/timestep.h"
#include "dem/touching.h"

namespace trackbed {
namespace {

/// Adds the time since the last call to one line of the profile.
class Stopwatch {
 public:
  void add_to(double& seconds) {
    const auto now = std::chrono::steady_clock::now();
    seconds += std::chrono::duration<double>(now - last_).count();
    last_ = now;
  }

 private:
  std::chrono::steady_clock::time_point last_ = std::chrono::steady_clock::now();
};

void look(const Model& model, State& state, const Workspace& work) {
  inspect(model, state, work);
  const StepPlan plan = plan_steps(model, state, work);
  state.planned_dt = plan.dt;
  state.next_look = state.step + plan.steps;
}

}  // namespace

void settle_contacts(const Model& model, State& state, Workspace& work) {
  work = {};
  prepare(model, state, work);
  rebuild_pairs(model, state, work);
  // A step of no length: overlaps and normals are found, nothing slides, stored shear is kept.
  contact_forces(model, state, work, 0.0);
  gather_forces(model, state, work, 0.0);
  look(model, state, work);
}

void find_contacts(const Model& model, State& state, Workspace& work) {
  work = {};
  prepare(model, state, work);
  rebuild_pairs(model, state, work);
  work.touching = sum_of_touching<int>(model, state, [](int& sum, const Touching&) { ++sum; });
}

void step(const Model& model, State& state, Workspace& work) {
  Stopwatch watch;
  if (state.planned_dt == 0) {
    settle_contacts(model, state, work);
  } else if (!work.pairs_are_valid) {
    find_contacts(model, state, work);  // the workspace was thrown away
  }
  watch.add_to(work.profile.search);
  const double dt = state.planned_dt;
  if (!std::isfinite(dt))
    throw RunError(
        "no stone and no body is there whose motion a time step could follow: let no time pass yet");

  move_clumps(model, state, work, dt);
  move_walls(model, state, work, dt);
  watch.add_to(work.profile.motion);

  if (pairs_are_due(state, work)) rebuild_pairs(model, state, work);
  watch.add_to(work.profile.search);
  contact_forces(model, state, work, dt);
  watch.add_to(work.profile.forces);
  gather_forces(model, state, work, dt);
  watch.add_to(work.profile.gather);

  state.dt = dt;
  state.time += dt;
  ++state.step;
  if (state.step >= state.next_look) look(model, state, work);
}

}  // namespace trackbed
