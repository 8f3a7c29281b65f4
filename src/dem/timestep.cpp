#include "dem/timestep.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include <fmt/format.h>

#include "base/error.h"
#include "dem/touching.h"

namespace trackbed {
namespace {

using Index = std::size_t;

/// Adds a contact's share: k_n along the normal, k_s across it, and the rolling spring across it.
void add_contact(const Touching& t, const Vec3& lever, const Mat3& axes, DiagonalStiffness& k) {
  const ContactProperties& p = *t.properties;
  const double kr =
      p.law == LawKind::linear_rolling ? LinearRolling::rolling_stiffness(p, t.radius) : 0.0;
  for (int a = 0; a < 3; ++a) {
    const double n = t.normal[a];
    k.shift[a] += p.kn * n * n + p.ks * (1.0 - n * n);
    const Vec3 axis = axes.col(a);
    const Vec3 motion = axis.cross(lever);
    const double along = t.normal.dot(motion);
    const double turned = axis.dot(t.normal);
    k.turn[a] += p.kn * along * along + p.ks * (motion.squaredNorm() - along * along) + kr * (1.0 - turned * turned);
  }
}

/// Largest shortening of the step by dashpots of this critical ratio.
double dashpot_factor(const PairTable& pairs) {
  double ratio = 0;
  for (int a = 0; a < pairs.size(); ++a)
    for (int b = 0; b < pairs.size(); ++b)
      ratio = std::max({ratio, pairs(a, b).dashpot.normal, pairs(a, b).dashpot.shear});
  return std::sqrt(1.0 + ratio * ratio) - ratio;
}

double shortest(const DiagonalStiffness& k, double mass, const Vec3& inertia) {
  double ratio = 0;  // K/m of the stiffest degree of freedom
  for (int a = 0; a < 3; ++a) ratio = std::max({ratio, k.shift[a] / mass, k.turn[a] / inertia[a]});
  return ratio > 0 ? 1.0 / std::sqrt(ratio) : std::numeric_limits<double>::infinity();
}

/// A stone that touches nothing may touch anything within the step: as if the stiffest contact were made.
void floor_stiffness(const Model& model, const Clumps& c, Index i, DiagonalStiffness& k) {
  const double stiffest = model.pairs.stiffest(c.material[i]);
  const double reach = model.templates[static_cast<Index>(c.shape[i])].bounding_radius * c.scale[i];
  k.shift = k.shift.cwiseMax(stiffest);
  k.turn = k.turn.cwiseMax(stiffest * reach * reach);
}

StableStep kinematic_step(const Model& model, const State& state, const Workspace& work) {
  StableStep step{std::numeric_limits<double>::infinity(), -1, true};
  const Clumps& c = state.clumps;
  double length = std::numeric_limits<double>::infinity();
  double speed = 0, acceleration = 0;
  for (Index i = 0; i < c.id.size(); ++i) {
    length = std::min(length, c.scale[i] * model.templates[static_cast<Index>(c.shape[i])].smallest_radius);
    const double v = c.velocity[i].norm() + work.bound[i] * c.angular_velocity[i].norm();
    acceleration = std::max(acceleration, (c.force[i] / c.mass[i] + model.gravity).norm());
    if (v > speed || std::isnan(v)) {
      speed = v;
      step.clump = static_cast<int>(i);
    }
  }
  for (Index w = 0; w < state.walls.size(); ++w)
    speed = std::max(speed, state.walls[w].velocity.norm() +
                                model.walls[w].shape.reach * state.walls[w].angular_velocity.norm());
  const double travel = model.time_step.largest_travel * length;
  const double root = std::sqrt(speed * speed + 2.0 * acceleration * travel);
  if (speed + root > 0) step.dt = 2.0 * travel / (speed + root);
  return step;
}

}  // namespace

DiagonalStiffness stiffness_of(const Model& model, const State& state, const Workspace& work, int clump) {
  DiagonalStiffness k;
  const Index c = static_cast<Index>(clump);
  const Mat3& axes = work.rotation[c];
  for (int e = work.first_entry[c]; e < work.first_entry[c + 1]; ++e) {
    const int entry = work.entries[static_cast<Index>(e)], pair = entry / 2;
    const PairBlock& block = state.pair_blocks[static_cast<Index>(pair / PairBlock::capacity)];
    const ClumpPair& p = block.pairs[static_cast<Index>(pair % PairBlock::capacity)];
    visit_pair(model, state, block, p, [&](const Touching& t) {
      add_contact(t, entry % 2 ? t.lever_2 : t.lever_1, axes, k);
    });
  }
  for (int e = work.first_wall_entry[c]; e < work.first_wall_entry[c + 1]; ++e) {
    const int pair = work.wall_entries[static_cast<Index>(e)];
    const WallBlock& block = state.wall_blocks[static_cast<Index>(pair / WallBlock::capacity)];
    const WallPair& p = block.pairs[static_cast<Index>(pair % WallBlock::capacity)];
    visit_pair(model, state, block, p, [&](const Touching& t) { add_contact(t, t.lever_1, axes, k); });
  }
  return k;
}

DiagonalStiffness stiffness_of_wall(const Model& model, const State& state, const Workspace& work, int wall) {
  DiagonalStiffness k;
  const Mat3& axes = work.wall_rotation[static_cast<Index>(wall)];
  const int last = work.first_pair_of_wall[static_cast<Index>(wall) + 1];
  for (int pair = work.first_pair_of_wall[static_cast<Index>(wall)]; pair < last; ++pair) {
    const WallBlock& block = state.wall_blocks[static_cast<Index>(pair / WallBlock::capacity)];
    visit_pair(model, state, block, block.pairs[static_cast<Index>(pair % WallBlock::capacity)],
               [&](const Touching& t) { add_contact(t, t.lever_2, axes, k); });
  }
  return k;
}

StableStep stable_step(const Model& model, const State& state, const Workspace& work) {
  StableStep step{std::numeric_limits<double>::infinity(), -1, false};
  const Clumps& c = state.clumps;
  std::vector<double> dt(c.id.size());
#pragma omp parallel for schedule(static) if (c.size() > 64)
  for (int i = 0; i < c.size(); ++i) {
    const Index k = static_cast<Index>(i);
    DiagonalStiffness stiffness = stiffness_of(model, state, work, i);
    floor_stiffness(model, c, k, stiffness);
    dt[k] = shortest(stiffness, c.mass[k], c.inertia[k]);
  }
  for (Index i = 0; i < dt.size(); ++i)
    if (dt[i] < step.dt) step = {dt[i], static_cast<int>(i), false};

  for (Index w = 0; w < model.walls.size(); ++w) {
    const auto& body = model.walls[w].body;
    if (!body) continue;
    DiagonalStiffness k = stiffness_of_wall(model, state, work, static_cast<int>(w));
    for (int a = 0; a < 3; ++a) {
      if (!body->free_shift[static_cast<Index>(a)]) k.shift[a] = 0;
      if (!(body->free_turn[0] || body->free_turn[1] || body->free_turn[2])) k.turn[a] = 0;
    }
    const double limit = shortest(k, body->mass, body->inertia);
    if (limit < step.dt) step = {limit, -1, false};
  }
  step.dt *= model.time_step.safety * dashpot_factor(model.pairs);

  const StableStep kinematic = kinematic_step(model, state, work);
  return kinematic.dt < step.dt ? kinematic : step;
}

double next_step(const Model& model, const State& state, const Workspace& work) {
  const StableStep stable = stable_step(model, state, work);
  const TimeStepRule& rule = model.time_step;
  if (rule.fixed) {
    if (*rule.fixed > stable.dt * (1.0 + 1e-12)) {
      const std::string who =
          stable.clump < 0 ? std::string("a body")
                           : fmt::format("stone {}", state.clumps.id[static_cast<Index>(stable.clump)]);
      throw RunError(fmt::format("the chosen time step {:.3g} s is above the stable one, {:.3g} s, that {} allows by its {}",
                                 *rule.fixed, stable.dt, who, stable.is_kinematic ? "speed" : "stiffness"));
    }
    return *rule.fixed;
  }
  if (state.dt == 0) return stable.dt;
  return std::min(stable.dt, state.dt * std::pow(rule.largest_growth, rule.interval));
}

}  // namespace trackbed
