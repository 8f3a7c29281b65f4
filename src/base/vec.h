// Vectors, rotations and poses. All lengths in metres, all frames right-handed, z up.
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>

namespace trackbed {

using Vec3 = Eigen::Vector3d;
using Mat3 = Eigen::Matrix3d;
using Quat = Eigen::Quaterniond;

/// Place and orientation of a rigid body: a body-frame point p lies at position + orientation * p.
struct Pose {
  Vec3 position = Vec3::Zero();  // [m]
  Quat orientation = Quat::Identity();

  Vec3 to_world(const Vec3& body_point) const { return position + orientation * body_point; }
  Vec3 to_body(const Vec3& world_point) const { return orientation.conjugate() * (world_point - position); }
};

}  // namespace trackbed
