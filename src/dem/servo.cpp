#include "dem/servo.h"

#include <algorithm>
#include <cmath>

#include "dem/touching.h"

namespace trackbed {

using Index = std::size_t;

double stiffness_along(const Model& model, const State& state, int wall, const Vec3& direction) {
  double k = 0;
  visit_wall(model, state, wall, [&](const Touching& t) {
    const double along = t.normal.dot(direction);
    k += t.properties->kn * along * along + t.properties->ks * (1.0 - along * along);
  });
  return k;
}

double servo_speed(const Model& model, const State& state, int wall, const Vec3& direction, double target) {
  constexpr double gain = 0.8, share_of_impact = 0.05;
  const Clumps& c = state.clumps;
  const double heaviest = c.mass.empty() ? 1.0 : *std::max_element(c.mass.begin(), c.mass.end());
  const double stiffest = model.pairs.stiffest(model.walls[static_cast<Index>(wall)].material);
  const double limit = share_of_impact * std::abs(target) / std::sqrt(heaviest * stiffest);

  const double missing = target + state.walls[static_cast<Index>(wall)].force.dot(direction);
  const double stiffness = stiffness_along(model, state, wall, direction);
  if (stiffness == 0) return missing > 0 ? limit : 0.0;
  return std::clamp(gain * missing / (stiffness * state.planned_dt), -limit, limit);
}

}  // namespace trackbed
