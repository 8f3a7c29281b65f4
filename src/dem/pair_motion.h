// How far the two bodies of a pair have moved against each other since their candidates were looked for.
#pragma once

#include <algorithm>

#include "base/vec.h"
#include "dem/workspace.h"

namespace trackbed {

/// A pair is looked through again when less than this share of its skin is left, rather than measured each
/// step.
inline constexpr double nearly_used_up = 0.25;

/// How near pebbles must be to become candidates of a pair (inner), and to be listed for the choice of
/// candidates (outer) [m].
struct Skin {
  double inner, outer;
};

/// Small distances keep idle candidates out of the lists of bodies that hardly move, larger ones spare fast
/// bodies a search at every step. `speed`: sum of those of the bodies' fastest pebbles [m/s].
inline Skin skin_of(const State& state, const Workspace& work, double speed) {
  // Before there are stones the planned step is endless, and the way not a number when they come at rest.
  const auto lasting = [&](int steps, double smallest_share) {
    const double way = steps * state.planned_dt * speed;
    return way < work.skin ? std::max(way, smallest_share * work.skin) : work.skin;
  };
  return {lasting(50, 0.02), lasting(1000, 0.2)};
}

/// Largest speed of a stone's pebbles [m/s].
inline double speed_of(const State& state, const Workspace& work, std::size_t clump) {
  return state.clumps.velocity[clump].norm() +
         work.swing[clump] * state.clumps.angular_velocity[clump].norm();
}

/// Pose of one body in the frame of another.
struct Relative {
  Vec3 offset;
  Quat turn;
};

inline Relative relative_pose(const Vec3& x1, const Quat& q1, const Vec3& x2, const Quat& q2) {
  const Quat back = q1.conjugate();
  return {back * (x2 - x1), back * q2};
}

/// Bound on how far any point within `reach` of body 2 has moved in the frame of body 1 since the search [m].
inline double motion_since(const PairSearch& search, const Relative& now, double reach) {
  const Quat turned = search.turn.conjugate() * now.turn;
  return (now.offset - search.offset).norm() + 2.0 * reach * turned.vec().norm();
}

}  // namespace trackbed
