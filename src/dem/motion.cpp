#include "dem/motion.h"

#include <algorithm>
#include <cmath>

#include "dem/rotation.h"

namespace trackbed {
namespace {

using Index = std::size_t;

double damped_component(double force, double velocity, double alpha) {
  if (velocity > 0) return force - alpha * std::abs(force);
  if (velocity < 0) return force + alpha * std::abs(force);
  return force;
}

/// Adds force x kick to the momentum-like quantity; returns the energy that damping took. `rate` is the
/// velocity that goes with `momentum` through the diagonal `inertia`.
double kick(const Vec3& unbalanced, const Vec3& inertia, double alpha, double duration, Vec3& rate) {
  const Vec3 force = damped(unbalanced, rate, alpha);
  const Vec3 before = rate;
  rate += duration * force.cwiseQuotient(inertia);
  return 0.5 * duration * (unbalanced - force).dot(before + rate);
}

/// Length of the chord that a point at distance 1 from the centre has gone at most.
double chord(const Quat& before, const Quat& after) {
  return 2.0 * (before.conjugate() * after).vec().norm();
}

void move_clump(const Model& model, State& state, Workspace& work, Index c, double kick_time, double dt) {
  Clumps& s = state.clumps;
  const double alpha = model.local_damping;
  double& lost = s.losses[c].damping;

  const Vec3 unbalanced = s.force[c] + s.mass[c] * model.gravity;
  lost += kick(unbalanced, Vec3::Constant(s.mass[c]), alpha, kick_time, s.velocity[c]);
  s.position[c] += dt * s.velocity[c];

  // Damping of the moment acts in the principal frame; without it the angular momentum is kept as it is.
  const Mat3& r = work.rotation[c];
  const Vec3& moment = s.moment[c];
  Vec3& angular_momentum = s.angular_momentum[c];
  if (alpha > 0) {
    const Vec3 moment_body = r.transpose() * moment;
    const Vec3 spin_body = (r.transpose() * angular_momentum).cwiseQuotient(s.inertia[c]);
    Vec3 spin_after = spin_body;
    lost += kick(moment_body, s.inertia[c], alpha, kick_time, spin_after);
    angular_momentum += kick_time * (r * damped(moment_body, spin_body, alpha));
  } else {
    angular_momentum += kick_time * moment;
  }
  const Quat before = s.orientation[c];
  rotate_freely(s.orientation[c], angular_momentum, s.inertia[c], dt);
  work.rotation[c] = s.orientation[c].toRotationMatrix();
  s.angular_velocity[c] = spin_of(work.rotation[c], s.inertia[c], angular_momentum);

  work.travel[c] += dt * s.velocity[c].norm() + work.bound[c] * chord(before, s.orientation[c]);
}

void move_body(const Model& model, const BodyProperties& body, WallState& wall, double kick_time, double dt) {
  const double alpha = model.local_damping;
  const Vec3 before = wall.velocity, spin_before = wall.angular_velocity;
  Vec3 unbalanced = wall.force + wall.applied_force + body.mass * model.gravity;
  for (int a = 0; a < 3; ++a)
    if (!body.free_shift[static_cast<Index>(a)]) unbalanced[a] = wall.velocity[a] = 0;
  wall.damping_loss += kick(unbalanced, Vec3::Constant(body.mass), alpha, kick_time, wall.velocity);
  wall.applied_work += 0.5 * kick_time * wall.applied_force.dot(before + wall.velocity);
  wall.pose.position += dt * wall.velocity;

  Vec3 moment = wall.moment + wall.applied_moment;
  for (int a = 0; a < 3; ++a)
    if (!body.free_turn[static_cast<Index>(a)]) moment[a] = wall.angular_momentum[a] = 0;
  if (!(body.free_turn[0] || body.free_turn[1] || body.free_turn[2])) return;
  const Mat3 r = wall.pose.orientation.toRotationMatrix();
  const Vec3 moment_body = r.transpose() * moment;
  Vec3 spin_body = (r.transpose() * wall.angular_momentum).cwiseQuotient(body.inertia);
  const Vec3 damped_moment = damped(moment_body, spin_body, alpha);
  wall.damping_loss += kick(moment_body, body.inertia, alpha, kick_time, spin_body);
  wall.angular_momentum += kick_time * (r * damped_moment);
  wall.angular_velocity = spin_of(r, body.inertia, wall.angular_momentum);
  bool all_free = true;
  for (int a = 0; a < 3; ++a) {
    if (body.free_turn[static_cast<Index>(a)]) continue;
    wall.angular_velocity[a] = 0;
    all_free = false;
  }
  if (all_free) {
    rotate_freely(wall.pose.orientation, wall.angular_momentum, body.inertia, dt);
    const Mat3 now = wall.pose.orientation.toRotationMatrix();
    wall.angular_velocity = spin_of(now, body.inertia, wall.angular_momentum);
  } else {
    // A blocked axis takes whatever moment it needs; the momentum is that of the turn that is left.
    wall.angular_momentum = r * (r.transpose() * wall.angular_velocity).cwiseProduct(body.inertia);
    const Vec3 half = 0.5 * dt * wall.angular_velocity;
    wall.pose.orientation = (Quat(1.0, half.x(), half.y(), half.z()) * wall.pose.orientation).normalized();
  }
  wall.applied_work += 0.5 * kick_time * wall.applied_moment.dot(spin_before + wall.angular_velocity);
}

/// Distance from the wall's origin beyond which its turning can touch no stone [m].
double reach_of(const Model& model, const State& state, const Workspace& work, std::size_t w) {
  const Vec3& spin = state.walls[w].angular_velocity;
  if (!model.walls[w].shape.is_plane || spin.isZero(0)) return model.walls[w].shape.reach;
  double reach = 0;  // a plane has no end: as far as the farthest stone
  for (std::size_t c = 0; c < work.bound.size(); ++c) {
    const double away = (state.clumps.position[c] - state.walls[w].pose.position).norm();
    reach = std::max(reach, away + work.bound[c]);
  }
  return reach;
}

}  // namespace

Vec3 damped(const Vec3& unbalanced, const Vec3& velocity, double alpha) {
  return {damped_component(unbalanced.x(), velocity.x(), alpha),
          damped_component(unbalanced.y(), velocity.y(), alpha),
          damped_component(unbalanced.z(), velocity.z(), alpha)};
}

void move_clumps(const Model& model, State& state, Workspace& work, double dt) {
  const double kick_time = 0.5 * (state.dt + dt);
  double largest = 0;
  const bool has_pairs = work.position_at_build.size() == state.clumps.position.size();
#pragma omp parallel for schedule(static) reduction(max : largest) if (state.clumps.size() > 64)
  for (int k = 0; k < state.clumps.size(); ++k) {
    const Index c = static_cast<Index>(k);
    move_clump(model, state, work, c, kick_time, dt);
    if (has_pairs)
      largest = std::max(largest, (state.clumps.position[c] - work.position_at_build[c]).squaredNorm());
  }
  work.largest_shift2 = largest;
}

void move_walls(const Model& model, State& state, Workspace& work, double dt) {
  const double kick_time = 0.5 * (state.dt + dt);
  for (Index w = 0; w < state.walls.size(); ++w) {
    WallState& wall = state.walls[w];
    if (!wall.present) continue;
    const Quat before = wall.pose.orientation;
    if (const auto& body = model.walls[w].body) {
      move_body(model, *body, wall, kick_time, dt);
    } else {
      wall.pose.position += dt * wall.velocity;
      const double angle = dt * wall.angular_velocity.norm();
      if (angle > 0) {
        const Quat turn(Eigen::AngleAxisd(angle, wall.angular_velocity.normalized()));
        wall.pose.orientation = (turn * wall.pose.orientation).normalized();
      }
    }
    work.wall_rotation[w] = wall.pose.orientation.toRotationMatrix();
    work.wall_travel[w] +=
        dt * wall.velocity.norm() + reach_of(model, state, work, w) * chord(before, wall.pose.orientation);
  }
}

}  // namespace trackbed
