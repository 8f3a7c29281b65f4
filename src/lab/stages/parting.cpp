#include "lab/stages/parting.h"

#include <algorithm>
#include <limits>
#include <vector>

#include <fmt/format.h>

#include "base/error.h"
#include "base/runs.h"
#include "dem/touching.h"
#include "lab/in_touch.h"

namespace trackbed {

Overlaps overlaps_of_stones(const Simulation& sim) {
  Overlaps all;
  int n = 0;
  const std::vector<double> radii = equal_volume_radii(sim.model, sim.state.clumps);
  visit_touching(sim.model, sim.state, [&](const Touching& t) {
    if (t.clump_2 < 0) return;
    const double radius = smaller_of_stones(t, [&](std::size_t i) { return radii[i]; });
    all.mean += t.overlap / radius;
    all.largest = std::max(all.largest, t.overlap / radius);
    ++n;
  });
  if (n > 0) all.mean /= n;
  return all;
}

bool is_softened(const Simulation& sim, int material) {
  return std::ranges::find(sim.model.walls, material, &Wall::material) == sim.model.walls.end();
}

namespace {

/// Scales the stiffness between stones whose materials no wall has.
void soften(const Simulation& sim, double share, PairTable& pairs) {
  for (int a = 0; a < pairs.size(); ++a)
    for (int b = 0; b < pairs.size(); ++b) {
      if (!is_softened(sim, a) || !is_softened(sim, b)) continue;
      pairs(a, b).kn *= share;
      pairs(a, b).ks *= share;
    }
}

}  // namespace

void Parting::open(Simulation& sim, double share_of_stiffness, double scaled_share) {
  start_ = sim.state.time;
  overlap_limit_ = sim.model.limits.overlap;
  smallest_ = std::numeric_limits<double>::infinity();
  for (std::size_t k = 0; k < sim.state.clumps.id.size(); ++k)
    smallest_ = std::min(smallest_, equal_volume_radius(sim, k));
  sim.model.gravity = Vec3::Zero();
  sim.model.local_damping = 0.7;
  // A small stone below large ones may be pressed past a plane: it comes back.
  Limits& limits = sim.model.limits;
  limits.overlap = limits.speed = limits.outside = std::numeric_limits<double>::infinity();
  sim.model.pairs = sim.model.pairs.with_friction_up_to(0);
  sim.scale_step(scaled_share);
  soften(sim, share_of_stiffness, sim.model.pairs);
  sim.changed();
}

void Parting::control(Simulation& sim) const {
  constexpr int stop_every = 50;
  if (sim.state.step % stop_every == 0) return sim.stop_stones();
  const Clumps& c = sim.state.clumps;
  const double limit = 0.01 * smallest_ / sim.state.planned_dt;
  for_each_by_runs(c.id.size(), [&](std::size_t k) {
    const double bound =
        c.scale[k] * sim.model.templates[static_cast<std::size_t>(c.shape[k])].bounding_radius;
    const double speed = c.velocity[k].norm() + bound * c.angular_velocity[k].norm();
    if (speed <= limit) return;
    set_motion(sim.state, static_cast<int>(k), limit / speed * c.velocity[k],
               limit / speed * c.angular_velocity[k]);
  });
}

bool Parting::is_done(const Simulation& sim, double mean_overlap, double time_limit) {
  constexpr int look_every = 50;
  if (sim.state.step % look_every != 0) return false;
  now_ = overlaps_of_stones(sim);
  if (now_.mean < mean_overlap && now_.largest < overlap_limit_) return true;
  if (sim.state.time - start_ > time_limit)
    throw RunError(
        fmt::format("the stones do not part: after {:.3g} s their mean overlap is {:.2g} % of a "
                    "radius, {:.2g} % was asked for: so many stones of these shapes do not fit, raise the "
                    "porosity",
                    time_limit, 100 * now_.mean, 100 * mean_overlap));
  return false;
}

Awaited Parting::awaited(double mean_overlap) const {
  if (now_.mean == 0) return {};
  return {"mean overlap", now_.mean, mean_overlap};
}

}  // namespace trackbed
