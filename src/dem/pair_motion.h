// How far the two bodies of a pair have moved against each other since their candidates were looked for.
#pragma once

#include "base/vec.h"
#include "dem/workspace.h"

namespace trackbed {

/// A pair is looked through again when less than this share of its skin is left, rather than measured each
/// step.
inline constexpr double nearly_used_up = 0.25;

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
