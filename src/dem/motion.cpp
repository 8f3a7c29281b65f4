#include "dem/motion.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "dem/rotation.h"
#include "dem/shares.h"

namespace trackbed {
namespace {

using Index = std::size_t;

template <class Real>
Real damped_component(const Real& force, const Real& velocity, double alpha) {
  const Real loss = Real(alpha) * abs(force), zero = 0.0;
  return force - select(velocity > zero, loss, select(velocity < zero, -loss, zero));
}

template <class Real>
Vec3Of<Real> damped_vector(const Vec3Of<Real>& unbalanced, const Vec3Of<Real>& velocity, double alpha) {
  return {damped_component(unbalanced.x(), velocity.x(), alpha),
          damped_component(unbalanced.y(), velocity.y(), alpha),
          damped_component(unbalanced.z(), velocity.z(), alpha)};
}

/// Changes a velocity by the damped force over `duration`; returns the energy that damping took. `mobility`
/// is one over the mass or the principal inertia.
template <class Real>
Real kick(const Vec3Of<Real>& unbalanced, const Vec3Of<Real>& mobility, double alpha, double duration,
          Vec3Of<Real>& rate) {
  const Vec3Of<Real> force = damped_vector(unbalanced, rate, alpha);
  const Vec3Of<Real> before = rate;
  rate += Real(duration) * Vec3Of<Real>(force.cwiseProduct(mobility));
  return Real(0.5 * duration) * (unbalanced - force).dot(before + rate);
}

/// Length of the chord that a point at distance 1 from the centre has gone at most.
template <class Real>
Real chord(const TurnOf<Real>& before, const TurnOf<Real>& after) {
  const auto& [w, x, y, z] = before;
  const auto& [a, b, c, d] = after;
  const Vec3Of<Real> turn(w * b - a * x - y * d + z * c, w * c - a * y - z * b + x * d,
                          w * d - a * z - x * c + y * b);
  return Real(2.0) * sqrt(turn.squaredNorm());
}

/// How a stone turns.
template <class Real>
struct Turning {
  Vec3Of<Real> angular_momentum;
  Vec3Of<Real> spin = Vec3Of<Real>::Zero();
  TurnOf<Real> turn;
  Real damping_loss;
};

/// Changes an angular momentum by the moment over `kick_time`, damped in the axes of `moment`, which are
/// principal.
template <class Real>
Vec3Of<Real> kick_turning(const Vec3Of<Real>& moment, const Vec3Of<Real>& momentum,
                          const Vec3Of<Real>& mobility, double alpha, double kick_time, Real& damping_loss) {
  const Vec3Of<Real> spin = momentum.cwiseProduct(mobility);
  Vec3Of<Real> after = spin;
  damping_loss += kick<Real>(moment, mobility, alpha, kick_time, after);
  return Real(kick_time) * damped_vector(moment, spin, alpha);
}

/// One step of turning. Damping of the moment acts in the principal frame; without it the angular momentum is
/// kept as it is.
template <class Real>
void turn_freely(Turning<Real>& t, const Vec3Of<Real>& moment, const Vec3Of<Real>& mobility, double alpha,
                 double kick_time, double dt) {
  if (alpha > 0) {
    const Mat3Of<Real> r = matrix_of(t.turn);
    const Vec3Of<Real> body_moment = r.transpose() * moment,
                       body_momentum = r.transpose() * t.angular_momentum;
    t.angular_momentum +=
        r * kick_turning<Real>(body_moment, body_momentum, mobility, alpha, kick_time, t.damping_loss);
  } else {
    t.angular_momentum += Real(kick_time) * moment;
  }
  t.turn = rotated_freely(t.turn, t.angular_momentum, mobility, dt);
  t.spin = spin_of<Real>(matrix_of(t.turn), mobility, t.angular_momentum);
}

/// The same for a stone whose principal moments are equal: all axes are principal, those of the world too.
template <class Real>
void turn_evenly(Turning<Real>& t, const Vec3Of<Real>& moment, const Vec3Of<Real>& mobility, double alpha,
                 double kick_time, double dt) {
  t.angular_momentum +=
      kick_turning<Real>(moment, t.angular_momentum, mobility, alpha, kick_time, t.damping_loss);
  t.turn = rotated_evenly(t.turn, t.angular_momentum, mobility.x(), dt);
  t.spin = mobility.x() * t.angular_momentum;
}

/// Stones on their way: one in each lane.
struct Movers {
  Vec3Of<Lanes> inertia, position, velocity, force, moment;
  Turning<Lanes> turning;
  Lanes mass, inertial_mass, swing, travel;
};

/// One step of several stones; returns how far a pebble of each can have gone [m].
Lanes move(const Model& model, Movers& m, double kick_time, double dt) {
  const double alpha = model.local_damping;
  const Vec3Of<Lanes> gravity(model.gravity.x(), model.gravity.y(), model.gravity.z());
  const Vec3Of<Lanes> mobility = Vec3Of<Lanes>::Constant(Lanes(1.0) / m.inertial_mass);
  m.turning.damping_loss += kick<Lanes>(m.force + m.mass * gravity, mobility, alpha, kick_time, m.velocity);
  m.position += Lanes(dt) * m.velocity;

  const Vec3Of<Lanes> ease = m.inertia.cwiseInverse();
  const TurnOf<Lanes> before = m.turning.turn;
  const LaneMask even = m.inertia.x() == m.inertia.y() && m.inertia.y() == m.inertia.z();
  Turning<Lanes> evenly = m.turning;
  if (any(!even)) turn_freely(m.turning, m.moment, ease, alpha, kick_time, dt);
  if (any(even)) {
    turn_evenly(evenly, m.moment, ease, alpha, kick_time, dt);
    m.turning.angular_momentum = select(even, evenly.angular_momentum, m.turning.angular_momentum);
    m.turning.spin = select(even, evenly.spin, m.turning.spin);
    m.turning.damping_loss = select(even, evenly.damping_loss, m.turning.damping_loss);
    for (std::size_t k = 0; k < 4; ++k) m.turning.turn[k] = select(even, evenly.turn[k], m.turning.turn[k]);
  }

  const Lanes way = Lanes(dt) * sqrt(m.velocity.squaredNorm()) + m.swing * chord(before, m.turning.turn);
  m.travel += way;
  return way;
}

/// Consecutive stones, one a lane, from `first` on; the last one stands in for those that are missing.
struct Batch {
  std::array<Index, Lanes::size> at;
  int count;

  Batch(Index first, Index n) : count(static_cast<int>(std::min<Index>(Lanes::size, n - first))) {
    for (Index k = 0; k < at.size(); ++k) at[k] = std::min(first + k, n - 1);
  }
  Vec3Of<Lanes> load(const std::vector<Vec3>& from) const {
    if (count == Lanes::size) return load_vectors(&from[at[0]]);
    Vec3Of<Lanes> v;
    for (int a = 0; a < 3; ++a) v[a] = each_lane([&](Index k) { return from[at[k]][a]; });
    return v;
  }
  void store(const Vec3Of<Lanes>& v, std::vector<Vec3>& to) const {
    if (count == Lanes::size) return store_vectors(v, &to[at[0]]);
    for (int k = 0; k < count; ++k) to[at[static_cast<Index>(k)]] = {v.x()[k], v.y()[k], v.z()[k]};
  }
  Lanes load(const std::vector<double>& from) const {
    if (count == Lanes::size) return Lanes::load(&from[at[0]]);
    return each_lane([&](Index k) { return from[at[k]]; });
  }
  void store(Lanes v, std::vector<double>& to) const {
    for (int k = 0; k < count; ++k) to[at[static_cast<Index>(k)]] = v[k];
  }
};

/// Moves one batch; returns the longest way of its stones [m].
[[gnu::flatten]] double move_batch(const Model& model, State& state, Workspace& work, const Batch& q,
                                   double kick_time, double dt) {
  Clumps& c = state.clumps;
  Movers m;
  m.inertia = q.load(c.inertia);
  m.position = q.load(c.position);
  m.velocity = q.load(c.velocity);
  m.turning.angular_momentum = q.load(c.angular_momentum);
  m.force = q.load(c.force);
  m.moment = q.load(c.moment);
  m.mass = q.load(c.mass);
  m.inertial_mass = q.load(c.inertial_mass);
  m.swing = q.load(work.swing);
  m.travel = q.load(work.travel);
  Rows orientations;  // x, y, z, w as Eigen stores them
  for (Index k = 0; k < orientations.size(); ++k)
    orientations[k] = Row::load(c.orientation[q.at[k]].coeffs().data());
  const Columns turn = columns_of(orientations);
  m.turning.turn = {turn[3], turn[0], turn[1], turn[2]};
  m.turning.damping_loss = each_lane([&](Index k) { return c.losses[q.at[k]].damping; });

  if (model.space.is_plane()) {  // rounding at edges that stand on the plane must not tip a stone out of it
    m.force.y() = m.moment.x() = m.moment.z() = 0.0;
  }

  const Lanes ways = move(model, m, kick_time, dt);

  q.store(m.position, c.position);
  q.store(m.velocity, c.velocity);
  q.store(m.turning.angular_momentum, c.angular_momentum);
  q.store(m.turning.spin, c.angular_velocity);
  q.store(m.travel, work.travel);
  const Vec3Of<Lanes>& w = m.turning.spin;
  const auto rows = [](const Vec3Of<Lanes>& v, Lanes fourth) {
    return rows_of({v.x(), v.y(), v.z(), fourth});
  };
  const auto& [tw, tx, ty, tz] = m.turning.turn;
  const Rows position = rows(m.position, q.load(c.scale)), velocity = rows(m.velocity, m.mass),
             spin = rows(w, Lanes(0.0)), turns = rows_of({tx, ty, tz, tw});
  double way = 0;
  for (Index k = 0; k < static_cast<Index>(q.count); ++k) {
    const Index at = q.at[k];
    turns[k].store(c.orientation[at].coeffs().data());
    c.losses[at].damping = m.turning.damping_loss[static_cast<int>(k)];
    work.motion[at] = {position[k], velocity[k], spin[k], turns[k]};
    way = std::max(way, ways[static_cast<int>(k)]);
  }
  return way;
}

/// Turns a body that is free about all axes, damped along the principal ones.
void turn_body(const BodyProperties& body, const Vec3& moment, double alpha, double kick_time, double dt,
               WallState& wall) {
  const Vec3 mobility = body.inertia.cwiseInverse();
  const Mat3 r = wall.pose.orientation.toRotationMatrix();
  const Vec3 moment_body = r.transpose() * moment;
  Vec3 spin_body = (r.transpose() * wall.angular_momentum).cwiseQuotient(body.inertia);
  const Vec3 damped_moment = damped(moment_body, spin_body, alpha);
  wall.damping_loss += kick<double>(moment_body, mobility, alpha, kick_time, spin_body);
  wall.angular_momentum += kick_time * (r * damped_moment);
  rotate_freely(wall.pose.orientation, wall.angular_momentum, body.inertia, dt);
  const Mat3 now = wall.pose.orientation.toRotationMatrix();
  wall.angular_velocity = spin_of<double>(now, mobility, wall.angular_momentum);
}

/// Turns a body that is free about some of the world's axes, damped along these. Bearings act about the other
/// ones only, so what they take leaves the momentum about the free ones alone: dL_f/dt = M_f, and
/// L_f = J_ff w_f with the inertia J about the world's axes (docs/theory.md, 6).
void turn_about_free_axes(const BodyProperties& body, const Vec3& all, double alpha, double kick_time,
                          double dt, WallState& wall) {
  const Mat3 r = wall.pose.orientation.toRotationMatrix();
  const Mat3 inertia = r * body.inertia.asDiagonal() * r.transpose();
  Mat3 of_free = inertia;
  Vec3 moment = all;
  for (int a = 0; a < 3; ++a) {
    if (body.free_turn[static_cast<Index>(a)]) continue;
    moment[a] = wall.angular_momentum[a] = 0;
    of_free.row(a).setZero();
    of_free.col(a).setZero();
    of_free(a, a) = 1;
  }
  const Mat3 mobility = of_free.inverse();
  const Vec3 before = mobility * wall.angular_momentum;
  const Vec3 acting = damped(moment, before, alpha);
  wall.angular_velocity = mobility * Vec3(wall.angular_momentum + kick_time * acting);
  wall.angular_momentum = inertia * wall.angular_velocity;
  wall.damping_loss += 0.5 * kick_time * (moment - acting).dot(before + wall.angular_velocity);
  const Vec3 half = 0.5 * dt * wall.angular_velocity;
  wall.pose.orientation = (Quat(1.0, half.x(), half.y(), half.z()) * wall.pose.orientation).normalized();
}

void move_body(const Model& model, const Wall& properties, WallState& wall, double kick_time, double dt) {
  const BodyProperties& body = *properties.body;
  const double alpha = model.local_damping;
  const Vec3 before = wall.velocity, spin_before = wall.angular_velocity;
  Vec3 unbalanced = wall.force + wall.applied_force + body.mass * model.gravity;
  for (int a = 0; a < 3; ++a)
    if (keeps_velocity(properties, wall, a)) unbalanced[a] = 0;
  wall.damping_loss +=
      kick<double>(unbalanced, Vec3::Constant(1.0 / body.mass), alpha, kick_time, wall.velocity);
  wall.applied_work += 0.5 * kick_time * wall.applied_force.dot(before + wall.velocity);
  wall.pose.position += dt * wall.velocity;

  const auto n_free = std::ranges::count(body.free_turn, true);
  if (n_free == 0) return;
  const Vec3 moment = wall.moment + wall.applied_moment;
  if (n_free == 3)
    turn_body(body, moment, alpha, kick_time, dt, wall);
  else
    turn_about_free_axes(body, moment, alpha, kick_time, dt, wall);
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
  return damped_vector(unbalanced, velocity, alpha);
}

void move_clumps(const Model& model, State& state, Workspace& work, double dt) {
  const double kick_time = 0.5 * (state.dt + dt);
  const Index n = state.clumps.id.size();
  const auto of_share = [&](const Share& own) {
    double way = 0;
    const Index last = work.first_clump(own.last);
    for (Index first = work.first_clump(own.first); first < last; first += Watch::group) {
      double longest = 0;
      for (Index k = first; k < std::min(first + Watch::group, n); k += Lanes::size)
        longest = std::max(longest, move_batch(model, state, work, Batch(k, n), kick_time, dt));
      work.group_way[first / Watch::group] = longest;
      way = std::max(way, longest);
    }
    return way;
  };
  work.way += joined_of_shares(work.patches(), of_share, [](double a, double b) { return std::max(a, b); });
}

void move_walls(const Model& model, State& state, Workspace& work, double dt) {
  const double kick_time = 0.5 * (state.dt + dt);
  double longest = 0;
  for (Index w = 0; w < state.walls.size(); ++w) {
    WallState& wall = state.walls[w];
    if (!wall.present) continue;
    const Quat before = wall.pose.orientation;
    if (model.walls[w].body && !wall.held) {
      move_body(model, model.walls[w], wall, kick_time, dt);
    } else {
      wall.pose.position += dt * wall.velocity;
      const double angle = dt * wall.angular_velocity.norm();
      if (angle > 0) {
        const Quat turn(Eigen::AngleAxisd(angle, wall.angular_velocity.normalized()));
        wall.pose.orientation = (turn * wall.pose.orientation).normalized();
      }
    }
    work.wall_rotation[w] = wall.pose.orientation.toRotationMatrix();
    const double way = dt * wall.velocity.norm() + reach_of(model, state, work, w) *
                                                       chord(turn_of(before), turn_of(wall.pose.orientation));
    work.wall_travel[w] += way;
    longest = std::max(longest, way);
  }
  work.wall_step_way = longest;
  work.wall_way += longest;
}

}  // namespace trackbed
