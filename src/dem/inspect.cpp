#include "dem/inspect.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <string>

#include <fmt/format.h>

#include "base/error.h"
#include "dem/motion.h"
#include "dem/rotation.h"
#include "dem/touching.h"

namespace trackbed {
namespace {

using Index = std::size_t;

[[noreturn]] void fail(const State& state, Index c, const std::string& what) {
  const Vec3& x = state.clumps.position[c];
  throw RunError(fmt::format("stone {} at ({:.4g}, {:.4g}, {:.4g}) m, step {}, t = {:.6g} s: {}",
                             state.clumps.id[c], x.x(), x.y(), x.z(), state.step, state.time, what));
}

/// Rate at t of a quantity whose rate is known at t - dt/2, with the damped force of the half step to come;
/// `lost` gains what damping takes meanwhile.
Vec3 half_kicked(const Vec3& rate, const Vec3& unbalanced, const Vec3& inertia, double alpha, double half,
                 double& lost) {
  const Vec3 force = damped(unbalanced, rate, alpha);
  const Vec3 after = rate + half * force.cwiseQuotient(inertia);
  lost += 0.5 * half * (unbalanced - force).dot(rate + after);
  return after;
}

double kinetic_energy(const Model& model, const State& state, Index i, double& lost) {
  const Clumps& c = state.clumps;
  const double half = 0.5 * state.dt;
  const Vec3 v = half_kicked(c.velocity[i], c.force[i] + c.mass[i] * model.gravity,
                             Vec3::Constant(c.inertial_mass[i]), model.local_damping, half, lost);
  const Mat3 r = damping_axes(c.orientation[i], c.inertia[i]);
  const Vec3 spin = (r.transpose() * c.angular_momentum[i]).cwiseQuotient(c.inertia[i]);
  const Vec3 w =
      half_kicked(spin, r.transpose() * c.moment[i], c.inertia[i], model.local_damping, half, lost);
  return 0.5 * (c.inertial_mass[i] * v.squaredNorm() + c.inertia[i].dot(w.cwiseAbs2()));
}

double kinetic_energy(const Model& model, const Wall& properties, const WallState& wall, double dt,
                      double& lost) {
  const BodyProperties& body = *properties.body;
  Vec3 unbalanced = wall.force + wall.applied_force + body.mass * model.gravity;
  for (int a = 0; a < 3; ++a)
    if (keeps_velocity(properties, wall, a)) unbalanced[a] = 0;
  const Vec3 v =
      half_kicked(wall.velocity, unbalanced, Vec3::Constant(body.mass), model.local_damping, 0.5 * dt, lost);
  const Mat3 r = wall.pose.orientation.toRotationMatrix();
  const Vec3 w = r.transpose() * wall.angular_velocity;
  return 0.5 * (body.mass * v.squaredNorm() + body.inertia.dot(w.cwiseAbs2()));
}

/// Of a stone by itself, its contacts left out.
std::optional<std::string> what_is_wrong(const Model& model, const Clumps& c, const Workspace& work,
                                         Index i) {
  const Limits& limits = model.limits;
  if (!c.position[i].allFinite() || !c.velocity[i].allFinite() || !c.angular_momentum[i].allFinite() ||
      !c.force[i].allFinite() || !c.moment[i].allFinite())
    return "a position, velocity or force is not a number: the run has blown up";
  const double speed = c.velocity[i].norm() + work.bound[i] * c.angular_velocity[i].norm();
  if (speed > limits.speed)
    return fmt::format("moves at {:.4g} m/s, above the limit of {:.4g} m/s: the run has blown up", speed,
                       limits.speed);
  if (!model.domain.isEmpty() && model.domain.exteriorDistance(c.position[i]) > limits.outside)
    return "has left the container";
  return std::nullopt;
}

double smallest_pebble(const Model& model, const Clumps& c, Index i) {
  return c.scale[i] * model.templates[static_cast<Index>(c.shape[i])].smallest_radius;
}

/// Of a contact; the first stone is the one to be named.
std::optional<std::string> what_is_wrong(const Model& model, const Clumps& c, const Touching& t) {
  const Limits& limits = model.limits;
  if (t.clump_2 < 0 && t.overlap > limits.through * t.radius &&
      !model.walls[static_cast<Index>(t.wall)].shape.is_plane)
    return fmt::format("a pebble of {:.3g} mm radius is about to be pushed through wall {}", 1e3 * t.radius,
                       model.walls[static_cast<Index>(t.wall)].shape.name);
  // No pebble is larger than its stone: hardly a contact needs the roots of volumes.
  const double least = smaller_of_stones(t, [&](Index i) { return smallest_pebble(model, c, i); });
  if (t.overlap <= limits.overlap * least) return std::nullopt;
  const double radius = smaller_of_stones(t, [&](Index i) { return equal_volume_radius(model, c, i); });
  if (t.overlap <= limits.overlap * radius) return std::nullopt;
  const std::string other = t.clump_2 >= 0
                                ? fmt::format("stone {}", c.id[static_cast<Index>(t.clump_2)])
                                : fmt::format("wall {}", model.walls[static_cast<Index>(t.wall)].shape.name);
  return fmt::format("overlaps {} by {:.3g} mm, {:.0f} % of its radius (limit {:.0f} %)", other,
                     1e3 * t.overlap, 100 * t.overlap / radius, 100 * limits.overlap);
}

/// The first of n things of which something is wrong, whoever finds it.
template <class IsWrong>
std::optional<Index> first_wrong(Index n, const IsWrong& is_wrong, Index least) {
  using First = std::optional<Index>;
  return joined_by_runs<First>(
      n,
      [&](First& first, Index k) {
        if (!first && is_wrong(k)) first = k;
      },
      [](const First& a, const First& b) { return a ? a : b; }, least);
}

void inspect_stones(const Model& model, const State& state, const Workspace& work) {
  const auto wrong = [&](Index c) { return what_is_wrong(model, state.clumps, work, c); };
  const auto is_wrong = [&](Index c) { return wrong(c).has_value(); };
  if (const auto first = first_wrong(state.clumps.id.size(), is_wrong, Runs::least_length))
    fail(state, *first, *wrong(*first));
}

template <class Block>
void inspect_contacts(const Model& model, const State& state, const std::vector<Block>& blocks) {
  const auto each_wrong = [&](Index block, const auto& tell) {
    const Block& b = blocks[block];
    for (const auto& pair : b.pairs)
      visit_pair(model, state, b, pair, [&](const Touching& t) {
        if (const auto what = what_is_wrong(model, state.clumps, t)) tell(t, *what);
      });
  };
  const auto has_wrong = [&](Index block) {
    bool is_wrong = false;
    each_wrong(block, [&](const Touching&, const std::string&) { is_wrong = true; });
    return is_wrong;
  };
  if (const auto first = first_wrong(blocks.size(), has_wrong, blocks_in_run))
    each_wrong(*first, [&](const Touching& t, const std::string& what) {
      fail(state, static_cast<Index>(t.clump_1), what);
    });
}

}  // namespace

void inspect(const Model& model, const State& state, const Workspace& work) {
  inspect_stones(model, state, work);
  for (const WallState& wall : state.walls)
    if (!wall.pose.position.allFinite() || !wall.velocity.allFinite())
      throw RunError(fmt::format("step {}, t = {:.6g} s: the motion of a wall or body is not a number",
                                 state.step, state.time));
  inspect_contacts(model, state, state.pair_blocks);
  inspect_contacts(model, state, state.wall_blocks);
}

EnergyBalance& EnergyBalance::operator+=(const EnergyBalance& other) {
  kinetic += other.kinetic;
  potential += other.potential;
  strain += other.strain;
  friction_loss += other.friction_loss;
  rolling_loss += other.rolling_loss;
  dashpot_loss += other.dashpot_loss;
  damping_loss += other.damping_loss;
  boundary_work += other.boundary_work;
  applied_work += other.applied_work;
  return *this;
}

EnergyBalance energy_of(const Model& model, const State& state) {
  const Clumps& c = state.clumps;
  EnergyBalance e = sum_by_runs<EnergyBalance>(c.id.size(), [&](EnergyBalance& sum, Index i) {
    sum.kinetic += kinetic_energy(model, state, i, sum.damping_loss);
    sum.potential -= c.mass[i] * model.gravity.dot(c.position[i]);
    sum.friction_loss += c.losses[i].friction;
    sum.rolling_loss += c.losses[i].rolling;
    sum.dashpot_loss += c.losses[i].dashpot;
    sum.damping_loss += c.losses[i].damping;
  });
  for (Index w = 0; w < state.walls.size(); ++w) {
    const WallState& wall = state.walls[w];
    e.boundary_work += wall.boundary_work;
    e.applied_work += wall.applied_work;
    e.damping_loss += wall.damping_loss;
    if (const auto& body = model.walls[w].body; body && wall.present) {
      e.kinetic += kinetic_energy(model, model.walls[w], wall, state.dt, e.damping_loss);
      e.potential -= body->mass * model.gravity.dot(wall.pose.position);
    }
  }
  e.strain = sum_of_touching<double>(model, state, [](double& sum, const Touching& t) {
    const ContactProperties& p = *t.properties;
    sum += 0.5 * p.kn * t.overlap * t.overlap;
    if (p.ks <= 0) return;
    sum += t.memory->shear.squaredNorm() / (2.0 * p.ks);
    if (p.law == LawKind::linear_rolling)
      sum += t.memory->rolling.squaredNorm() / (2.0 * LinearRolling::rolling_stiffness(p, t.radius));
  });
  return e;
}

double unbalanced_ratio(const Model& model, const State& state) {
  const Clumps& c = state.clumps;
  double unbalanced = sum_by_runs<double>(
      c.id.size(), [&](double& sum, Index i) { sum += (c.force[i] + c.mass[i] * model.gravity).norm(); });
  double all = model.gravity.norm() *
               sum_by_runs<double>(c.id.size(), [&](double& sum, Index i) { sum += c.mass[i]; });
  for (Index w = 0; w < model.walls.size(); ++w) {
    const std::optional<BodyProperties>& body = model.walls[w].body;
    const WallState& wall = state.walls[w];
    if (!body || !wall.present || wall.held) continue;
    Vec3 weight = body->mass * model.gravity, sum = wall.force + weight + wall.applied_force;
    for (int a = 0; a < 3; ++a)
      if (!body->free_shift[static_cast<Index>(a)]) weight[a] = sum[a] = 0;
    unbalanced += sum.norm();
    all += weight.norm();
  }
  // Every contact between stones acts on two of them.
  all += sum_of_touching<double>(model, state, [](double& sum, const Touching& t) {
    sum += (t.clump_2 >= 0 ? 2.0 : 1.0) * t.force().norm();
  });
  return all > 0 ? unbalanced / all : 0.0;
}

}  // namespace trackbed
