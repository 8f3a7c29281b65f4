// One touching contact: its motion, its memory, its force. Bodies are numbered 1 and 2; the normal points
// from 1 to 2; force and moment are those that body 2 receives; pressing is positive.
#pragma once

#include "base/vec.h"

namespace trackbed {

/// What a contact remembers from step to step. No overlap says that it does not touch.
struct ContactMemory {
  double overlap = 0;  // [m]
  Vec3 normal = Vec3::Zero();
  Vec3 shear = Vec3::Zero();    // shear force on body 2 [N]
  Vec3 rolling = Vec3::Zero();  // rolling moment on body 2 [N m]

  bool touches() const { return overlap > 0; }
};

/// Geometry and motion of a touching contact during one step.
struct ContactKinematics {
  double overlap;       // [m], > 0
  Vec3 normal;          // unit vector from 1 to 2
  Vec3 velocity;        // of body 2 relative to body 1 at the contact point [m/s]
  Vec3 spin;            // of body 2 relative to body 1 [rad/s]
  double mean_twist;    // mean spin of the two bodies about the normal [rad/s]
  double radius;        // effective: 1/(1/R1 + 1/R2) [m]
  double reduced_mass;  // m1 m2/(m1 + m2); of the one body against a wall [kg]
  double dt;            // [s]
};

/// Energy a contact turned into heat during one step [J].
struct Losses {
  double friction = 0;
  double rolling = 0;
  double dashpot = 0;

  Losses& operator+=(const Losses& other) {
    friction += other.friction;
    rolling += other.rolling;
    dashpot += other.dashpot;
    return *this;
  }
};

struct ContactForce {
  Vec3 force;   // on body 2 [N]
  Vec3 moment;  // on body 2 at the contact point [N m]
};

/// Rotates a stored tangential vector by the smallest rotation that carries the old normal to the new one,
/// then by `twist` radians about the new one. Keeps its length.
inline Vec3 carry_along(const Vec3& stored, const Vec3& old_normal, const Vec3& normal, double twist) {
  const Vec3 axis = old_normal.cross(normal);  // length sin of the angle
  const double cosine = old_normal.dot(normal);
  const Vec3 tilted = cosine * stored + axis.cross(stored) + axis.dot(stored) / (1.0 + cosine) * axis;
  const double t = 0.5 * twist * (1.0 + twist * twist / 12.0);  // tan(twist/2) to fifth order
  const Vec3 turned = ((1.0 - t * t) * tilted + 2.0 * t * normal.cross(tilted)) / (1.0 + t * t);
  return turned - turned.dot(normal) * normal;
}

}  // namespace trackbed
