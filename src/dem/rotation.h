// Free rotation of a rigid body over one step, for one body (double) or several at once (Lanes).
#pragma once

#include <array>

#include "base/lanes.h"
#include "base/vec.h"

namespace trackbed {

/// Angular velocity [rad/s], world axes. `mobility` is here and below one over the principal inertia
/// [1/(kg m^2)].
template <class Real>
Vec3Of<Real> spin_of(const Mat3Of<Real>& rotation, const Vec3Of<Real>& mobility,
                     const Vec3Of<Real>& angular_momentum) {
  const Vec3Of<Real> body = rotation.transpose() * angular_momentum;
  return rotation * Vec3Of<Real>(body.cwiseProduct(mobility));
}

/// A unit quaternion, principal axes to world: w, x, y, z.
template <class Real>
using TurnOf = std::array<Real, 4>;

template <class Real>
Mat3Of<Real> matrix_of(const TurnOf<Real>& q) {
  const auto& [w, x, y, z] = q;
  const Real one = 1.0, x2 = x + x, y2 = y + y, z2 = z + z;
  const Real wx = x2 * w, wy = y2 * w, wz = z2 * w, xx = x2 * x, xy = y2 * x, xz = z2 * x, yy = y2 * y,
             yz = z2 * y, zz = z2 * z;
  Mat3Of<Real> r;
  r(0, 0) = one - (yy + zz);
  r(0, 1) = xy - wz;
  r(0, 2) = xz + wy;
  r(1, 0) = xy + wz;
  r(1, 1) = one - (xx + zz);
  r(1, 2) = yz - wx;
  r(2, 0) = xz - wy;
  r(2, 1) = yz + wx;
  r(2, 2) = one - (xx + yy);
  return r;
}

/// A vector carried from the principal axes to the world.
template <class Real>
Vec3Of<Real> rotated(const TurnOf<Real>& q, const Vec3Of<Real>& v) {
  const Vec3Of<Real> axis(q[1], q[2], q[3]);
  const Vec3Of<Real> half = axis.cross(v), across = half + half;
  return v + q[0] * across + axis.cross(across);
}

template <class Real>
void normalize(TurnOf<Real>& q) {
  const Real shrink = Real(1.0) / sqrt(q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3]);
  for (Real& part : q) part *= shrink;
}

/// Turns a body by the angle 2 atan(t) about its own principal axis `axis` (0, 1, 2); `momentum` is the
/// angular momentum seen from the body, which turns the other way. The quaternion grows by sqrt(1 + t^2).
template <class Real>
void turn_about_axis(TurnOf<Real>& q, Vec3Of<Real>& momentum, int axis, const Real& t) {
  const int j = (axis + 1) % 3, k = (axis + 2) % 3;
  const Real one = 1.0, shrink = one / (one + t * t);
  const Real c = (one - t * t) * shrink, s = (t + t) * shrink;
  const Real mj = momentum[j], mk = momentum[k];
  momentum[j] = c * mj + s * mk;
  momentum[k] = c * mk - s * mj;
  const auto part = [&](int a) -> Real& { return q[static_cast<std::size_t>(a) + 1]; };
  const Real qw = q[0], qa = part(axis), qj = part(j), qk = part(k);
  q[0] = qw - t * qa;
  part(axis) = qa + t * qw;
  part(j) = qj + t * qk;
  part(k) = qk - t * qj;
}

/// Moves the orientation through a free rotation of length dt [s] with constant angular momentum (world
/// axes): turns about the principal axes 1, 2, 3, 2, 1 in sequence, each the exact motion of its part of the
/// kinetic energy (Dullweber, Leimkuhler & McLachlan 1997), but for the tangent of the half angle, which is
/// taken as half the angle: the map stays symplectic, and no sine is needed. The angular momentum is kept to
/// rounding, the energy without drift.
template <class Real>
TurnOf<Real> rotated_freely(const TurnOf<Real>& before, const Vec3Of<Real>& angular_momentum,
                            const Vec3Of<Real>& mobility, double dt) {
  TurnOf<Real> q = before;
  Vec3Of<Real> momentum = matrix_of(q).transpose() * angular_momentum;
  const Vec3Of<Real> share = Real(0.5 * dt) * mobility;
  const auto turn = [&](int axis, double part) {
    turn_about_axis<Real>(q, momentum, axis, Real(part) * share[axis] * momentum[axis]);
  };
  turn(0, 0.5);
  turn(1, 0.5);
  turn(2, 1.0);
  turn(1, 0.5);
  turn(0, 0.5);
  normalize(q);
  return q;
}

/// The same for a body whose principal moments are equal: one turn about the angular momentum.
template <class Real>
TurnOf<Real> rotated_evenly(const TurnOf<Real>& q, const Vec3Of<Real>& angular_momentum, const Real& mobility,
                            double dt) {
  const Vec3Of<Real> t = (Real(0.5 * dt) * mobility) * angular_momentum;
  TurnOf<Real> out{
      q[0] - t.x() * q[1] - t.y() * q[2] - t.z() * q[3], q[1] + t.x() * q[0] + t.y() * q[3] - t.z() * q[2],
      q[2] + t.y() * q[0] + t.z() * q[1] - t.x() * q[3], q[3] + t.z() * q[0] + t.x() * q[2] - t.y() * q[1]};
  normalize(out);
  return out;
}

inline TurnOf<double> turn_of(const Quat& q) {
  return {q.w(), q.x(), q.y(), q.z()};
}
inline Quat quat_of(const TurnOf<double>& q) {
  return {q[0], q[1], q[2], q[3]};
}

/// Whether all axes are principal.
inline bool is_even(const Vec3& inertia) {
  return inertia[0] == inertia[1] && inertia[1] == inertia[2];
}

/// Axes in which the moment on a stone is damped, as columns: its principal ones, or those of the world when
/// all are.
inline Mat3 damping_axes(const Quat& q, const Vec3& inertia) {
  return is_even(inertia) ? Mat3(Mat3::Identity()) : q.toRotationMatrix();
}

/// For one body, whatever its inertia.
inline void rotate_freely(Quat& q, const Vec3& angular_momentum, const Vec3& inertia, double dt) {
  q = quat_of(is_even(inertia)
                  ? rotated_evenly(turn_of(q), angular_momentum, 1.0 / inertia[0], dt)
                  : rotated_freely<double>(turn_of(q), angular_momentum, inertia.cwiseInverse(), dt));
}

}  // namespace trackbed
