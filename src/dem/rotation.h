// Free rotation of a rigid body over one step.
#pragma once

#include <cmath>

#include "base/vec.h"

namespace trackbed {

/// Angular velocity [rad/s], world axes, of a body with the given principal inertia [kg m^2].
inline Vec3 spin_of(const Mat3& rotation, const Vec3& inertia, const Vec3& angular_momentum) {
  return rotation * (rotation.transpose() * angular_momentum).cwiseQuotient(inertia);
}

/// Turns a body by `angle` about its own principal axis `axis` (0, 1, 2). The tangent of the half angle is taken as
/// half the angle: the flow stays symplectic, and no sine is needed.
inline void turn_about_axis(Quat& q, int axis, double angle) {
  const double t = 0.5 * angle;
  const double w = q.w(), x = q.x(), y = q.y(), z = q.z();
  if (axis == 0)
    q = Quat(w - t * x, x + t * w, y + t * z, z - t * y);
  else if (axis == 1)
    q = Quat(w - t * y, x - t * z, y + t * w, z + t * x);
  else
    q = Quat(w - t * z, x + t * y, y - t * x, z + t * w);
  q.normalize();
}

/// Moves the orientation through a free rotation of length dt [s] with constant angular momentum (world axes):
/// turns about the principal axes 1, 2, 3, 2, 1 in sequence, each the exact motion of its part of the kinetic
/// energy (Dullweber, Leimkuhler & McLachlan 1997). The angular momentum is kept to rounding, the energy without
/// drift.
inline void rotate_freely(Quat& q, const Vec3& angular_momentum, const Vec3& inertia, double dt) {
  if (inertia[0] == inertia[1] && inertia[1] == inertia[2]) {
    const Vec3 half = (0.5 * dt / inertia[0]) * angular_momentum;
    q = Quat(1.0, half.x(), half.y(), half.z()) * q;
    q.normalize();
    return;
  }
  const auto turn = [&](int axis, double share) {
    const Vec3 unit = q * Vec3(axis == 0, axis == 1, axis == 2);
    turn_about_axis(q, axis, share * dt * unit.dot(angular_momentum) / inertia[axis]);
  };
  turn(0, 0.5);
  turn(1, 0.5);
  turn(2, 1.0);
  turn(1, 0.5);
  turn(0, 0.5);
}

}  // namespace trackbed
