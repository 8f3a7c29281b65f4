// Free rotation of a rigid body over one step.
#pragma once

#include <cmath>

#include "base/vec.h"

namespace trackbed {

/// Angular velocity [rad/s], world axes, of a body with the given principal inertia [kg m^2].
inline Vec3 spin_of(const Mat3& rotation, const Vec3& inertia, const Vec3& angular_momentum) {
  return rotation * (rotation.transpose() * angular_momentum).cwiseQuotient(inertia);
}

/// Turns a body by the angle 2 atan(t) about its own principal axis `axis` (0, 1, 2); `momentum` is the
/// angular momentum seen from the body, which turns the other way. The quaternion grows by sqrt(1 + t^2).
inline void turn_about_axis(Quat& q, Vec3& momentum, int axis, double t) {
  const int j = (axis + 1) % 3, k = (axis + 2) % 3;
  const double c = (1.0 - t * t) / (1.0 + t * t), s = 2.0 * t / (1.0 + t * t);
  const double mj = momentum[j], mk = momentum[k];
  momentum[j] = c * mj + s * mk;
  momentum[k] = c * mk - s * mj;
  Vec3 half = Vec3::Zero();
  half[axis] = t;
  q = q * Quat(1.0, half.x(), half.y(), half.z());
}

/// Moves the orientation through a free rotation of length dt [s] with constant angular momentum (world
/// axes): turns about the principal axes 1, 2, 3, 2, 1 in sequence, each the exact motion of its part of the
/// kinetic energy (Dullweber, Leimkuhler & McLachlan 1997), but for the tangent of the half angle, which is
/// taken as half the angle: the map stays symplectic, and no sine is needed. The angular momentum is kept to
/// rounding, the energy without drift.
inline void rotate_freely(Quat& q, const Vec3& angular_momentum, const Vec3& inertia, double dt) {
  if (inertia[0] == inertia[1] && inertia[1] == inertia[2]) {
    const Vec3 half = (0.5 * dt / inertia[0]) * angular_momentum;
    q = Quat(1.0, half.x(), half.y(), half.z()) * q;
    q.normalize();
    return;
  }
  Vec3 momentum = q.conjugate() * angular_momentum;
  const auto turn = [&](int axis, double share) {
    turn_about_axis(q, momentum, axis, 0.5 * share * dt * momentum[axis] / inertia[axis]);
  };
  turn(0, 0.5);
  turn(1, 0.5);
  turn(2, 1.0);
  turn(1, 0.5);
  turn(0, 0.5);
  q.normalize();
}

}  // namespace trackbed
