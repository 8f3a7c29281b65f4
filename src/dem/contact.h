// One touching contact: its motion, its memory, its force. Bodies are numbered 1 and 2; the normal points
// from 1 to 2; force and moment are those that body 2 receives; pressing is positive. All for one contact
// (double) or for several at once (Lanes).
#pragma once

#include <algorithm>
#include <cstddef>

#include "base/lanes.h"
#include "base/vec.h"

namespace trackbed {

/// What a contact remembers from step to step. No overlap says that it does not touch. Each vector begins a
/// row of four numbers.
template <class Real>
struct ContactMemoryOf {
  static constexpr std::size_t row = std::max<std::size_t>(32, alignof(Vec3Of<Real>));
  alignas(row) Vec3Of<Real> normal = Vec3Of<Real>::Zero();
  Real overlap = 0.0;                                        // [m]
  alignas(row) Vec3Of<Real> shear = Vec3Of<Real>::Zero();    // shear force on body 2 [N]
  alignas(row) Vec3Of<Real> rolling = Vec3Of<Real>::Zero();  // rolling moment on body 2 [N m]

  auto touches() const { return overlap > Real(0.0); }
  template <class A>
  void archive(A& a) {
    a(normal, overlap, shear, rolling);
  }
};
using ContactMemory = ContactMemoryOf<double>;

/// Geometry and motion of a touching contact during one step.
template <class Real>
struct ContactKinematicsOf {
  Real overlap;           // [m], > 0
  Vec3Of<Real> normal;    // unit vector from 1 to 2
  Vec3Of<Real> velocity;  // of body 2 relative to body 1 at the contact point [m/s]
  Vec3Of<Real> spin;      // of body 2 relative to body 1 [rad/s]
  Real mean_twist;        // mean spin of the two bodies about the normal [rad/s]
  Real radius;            // effective: 1/(1/R1 + 1/R2) [m]
  Real reduced_mass;      // m1 m2/(m1 + m2); of the one body against a wall [kg]
  double dt;              // [s]
};
using ContactKinematics = ContactKinematicsOf<double>;

/// Energy a contact turned into heat during one step [J].
template <class Real>
struct LossesOf {
  Real friction = 0.0;
  Real rolling = 0.0;
  Real dashpot = 0.0;

  template <class A>
  void archive(A& a) {
    a(friction, rolling, dashpot);
  }
  LossesOf& operator+=(const LossesOf& other) {
    friction += other.friction;
    rolling += other.rolling;
    dashpot += other.dashpot;
    return *this;
  }
};
using Losses = LossesOf<double>;

template <class Real>
struct ContactForceOf {
  Vec3Of<Real> force;   // on body 2 [N]
  Vec3Of<Real> moment;  // on body 2 at the contact point [N m]
};
using ContactForce = ContactForceOf<double>;

/// Rotates a stored tangential vector by the smallest rotation that carries the old normal to the new one,
/// then by `twist` radians about the new one. Keeps its length.
template <class Real>
Vec3Of<Real> carry_along(const Vec3Of<Real>& stored, const Vec3Of<Real>& old_normal,
                         const Vec3Of<Real>& normal, const Real& twist) {
  const Real one = 1.0;
  const Real t = Real(0.5) * twist * (one + twist * twist * Real(1.0 / 12.0));  // tan(twist/2), fifth order
  const Real a = one + old_normal.dot(normal), b = one + t * t;
  const Real both = one / (a * b);  // one division for 1/a and 1/b
  // A vector across the old normal needs no more than this of Rodrigues' formula.
  const Vec3Of<Real> tilted = stored - (stored.dot(normal) * (b * both)) * (old_normal + normal);
  const Real shrink = a * both;
  const Vec3Of<Real> turned =
      ((one - t * t) * shrink) * tilted + (Real(2.0) * t * shrink) * normal.cross(tilted);
  return turned - turned.dot(normal) * normal;
}

}  // namespace trackbed
