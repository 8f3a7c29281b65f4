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

/// Adds a contact's share: k_n along the normal, k_s across it, the rolling spring across it, and its
/// dashpots.
void add_contact(const Touching& t, const Vec3& lever, const Mat3& axes, DiagonalStiffness& k) {
  const ContactProperties& p = *t.properties;
  const double kr = p.law == LawKind::linear_rolling ? LinearRolling::rolling_stiffness(p, t.radius) : 0.0;
  const double cn = 2.0 * p.dashpot.normal * std::sqrt(t.reduced_mass * p.kn);
  const double cs = 2.0 * p.dashpot.shear * std::sqrt(t.reduced_mass * p.ks);
  for (int a = 0; a < 3; ++a) {
    const double n2 = t.normal[a] * t.normal[a];
    k.shift[a] += p.kn * n2 + p.ks * (1.0 - n2);
    k.viscous_shift[a] += cn * n2 + cs * (1.0 - n2);
    const Vec3 axis = axes.col(a);
    const Vec3 motion = axis.cross(lever);
    const double along2 = std::pow(t.normal.dot(motion), 2), across2 = motion.squaredNorm() - along2;
    k.turn[a] += p.kn * along2 + p.ks * across2 + kr * (1.0 - std::pow(axis.dot(t.normal), 2));
    k.viscous_turn[a] += cn * along2 + cs * across2;
  }
}

/// 1/omega of one degree of freedom, shortened by its own critical ratio [s].
double limit_of(double stiffness, double viscous, double mass) {
  if (stiffness <= 0) return std::numeric_limits<double>::infinity();
  const double omega = std::sqrt(stiffness / mass);
  const double ratio = 0.5 * viscous / (mass * omega);
  return (std::sqrt(1.0 + ratio * ratio) - ratio) / omega;
}

double shortest(const DiagonalStiffness& k, double mass, const Vec3& inertia) {
  double limit = std::numeric_limits<double>::infinity();
  for (int a = 0; a < 3; ++a)
    limit = std::min({limit, limit_of(k.shift[a], k.viscous_shift[a], mass),
                      limit_of(k.turn[a], k.viscous_turn[a], inertia[a])});
  return limit;
}

/// A body that touches nothing may touch anything within the step: as if the stiffest contact were made at
/// its farthest point, whose rolling spring is no stiffer than its shear spring there.
void floor_stiffness(const PairTable& pairs, int material, double reach, double mass, DiagonalStiffness& k) {
  const double stiffest = pairs.stiffest(material);
  bool rolls = false;
  double ratio = 0;
  for (int other = 0; other < pairs.size(); ++other) {
    const ContactProperties& p = pairs(material, other);
    rolls = rolls || p.law == LawKind::linear_rolling;
    ratio = std::max({ratio, p.dashpot.normal, p.dashpot.shear});
  }
  const double viscous = 2.0 * ratio * std::sqrt(mass * stiffest);
  k.shift = k.shift.cwiseMax(stiffest);
  k.viscous_shift = k.viscous_shift.cwiseMax(viscous);
  k.turn = k.turn.cwiseMax((rolls ? 2.0 : 1.0) * stiffest * reach * reach);
  k.viscous_turn = k.viscous_turn.cwiseMax(viscous * reach * reach);
}

/// Of a stone with contacts of this stiffness [s].
double limit_of_clump(const Model& model, const State& state, const Workspace& work, Index c,
                      DiagonalStiffness k) {
  floor_stiffness(model.pairs, state.clumps.material[c], work.bound[c], state.clumps.inertial_mass[c], k);
  return shortest(k, state.clumps.inertial_mass[c], state.clumps.inertia[c]);
}

double limit_of_body(const Model& model, const State& state, const Workspace& work, Index w) {
  const BodyProperties& body = *model.walls[w].body;
  DiagonalStiffness k = stiffness_of_wall(model, state, work, static_cast<int>(w));
  floor_stiffness(model.pairs, model.walls[w].material, model.walls[w].shape.reach, body.mass, k);
  for (int a = 0; a < 3; ++a)
    if (!body.free_shift[static_cast<Index>(a)]) k.shift[a] = 0;
  if (!(body.free_turn[0] || body.free_turn[1] || body.free_turn[2])) k.turn = Vec3::Zero();
  return shortest(k, body.mass, body.inertia);
}

/// How lively a bed is.
struct Pace {
  double length = std::numeric_limits<double>::infinity();  // smallest pebble radius [m]
  double speed = 0, acceleration = 0;                       // largest [m/s], [m/s^2]
  int clump = -1;                                           // the fastest
};

/// Of two sets of stones; of equally fast ones the first, whoever is asked first.
Pace livelier(const Pace& a, const Pace& b) {
  const bool is_faster = b.speed > a.speed || (b.speed == a.speed && b.clump >= 0 && b.clump < a.clump);
  Pace pace = is_faster ? b : a;
  pace.length = std::min(a.length, b.length);
  pace.acceleration = std::max(a.acceleration, b.acceleration);
  return pace;
}

Pace pace_of_clump(const Model& model, const State& state, const Workspace& work, Index i) {
  const Clumps& c = state.clumps;
  return {.length = c.scale[i] * model.templates[static_cast<Index>(c.shape[i])].smallest_radius,
          .speed = c.velocity[i].norm() + work.bound[i] * c.angular_velocity[i].norm(),
          .acceleration = (c.force[i] / c.mass[i] + model.gravity).norm() * (c.mass[i] / c.inertial_mass[i]),
          .clump = static_cast<int>(i)};
}

Pace pace_of(const Model& model, const State& state, const Workspace& work) {
  Pace pace = joined_by_runs<Pace>(
      state.clumps.id.size(),
      [&](Pace& all, Index c) { all = livelier(all, pace_of_clump(model, state, work, c)); }, livelier);
  for (Index w = 0; w < state.walls.size(); ++w) {
    const WallState& wall = state.walls[w];
    if (!wall.present) continue;
    pace.speed = std::max(pace.speed,
                          wall.velocity.norm() + model.walls[w].shape.reach * wall.angular_velocity.norm());
    if (const auto& body = model.walls[w].body)
      pace.acceleration = std::max(pace.acceleration,
                                   ((wall.force + wall.applied_force) / body->mass + model.gravity).norm());
  }
  return pace;
}

StableStep kinematic_step(const Model& model, const Pace& pace) {
  const double travel = model.time_step.largest_travel * pace.length;
  const double root = std::sqrt(pace.speed * pace.speed + 2.0 * pace.acceleration * travel);
  const double dt =
      pace.speed + root > 0 ? 2.0 * travel / (pace.speed + root) : std::numeric_limits<double>::infinity();
  return {dt, pace.clump, true, 0};
}

/// Steps of length dt for which no stone goes farther than it may in the shortest interval.
int steps_for(const TimeStepRule& rule, const Pace& pace, double dt) {
  const double way = rule.shortest_interval * rule.largest_travel * pace.length;
  const double speed = pace.speed + pace.acceleration * rule.longest_interval * dt;
  const double steps = std::floor(way / (speed * dt));
  if (!(steps > rule.shortest_interval)) return rule.shortest_interval;
  return steps < rule.longest_interval ? static_cast<int>(steps) : rule.longest_interval;
}

/// Of two limits of stones the shorter; of equal ones that of the first stone, whoever is asked first.
StableStep shorter(const StableStep& a, const StableStep& b) {
  return b.dt < a.dt || (b.dt == a.dt && b.clump < a.clump) ? b : a;
}

/// Of each stone: a look at all contacts that both the scaling and the step want.
std::vector<DiagonalStiffness> stiffnesses_of(const Model& model, const State& state, const Workspace& work) {
  std::vector<DiagonalStiffness> all(state.clumps.id.size());
  for_each_by_runs(all.size(),
                   [&](Index c) { all[c] = stiffness_of(model, state, work, static_cast<int>(c)); });
  return all;
}

/// The stable step with what `stiffness(c)` tells of each stone.
template <class StiffnessOf>
StableStep stable_step_with(const Model& model, const State& state, const Workspace& work,
                            const StiffnessOf& stiffness) {
  StableStep step = joined_by_runs<StableStep>(
      state.clumps.id.size(),
      [&](StableStep& all, Index c) {
        const double limit = limit_of_clump(model, state, work, c, stiffness(c));
        all = shorter(all, {limit, static_cast<int>(c), false, 0});
      },
      shorter);
  for (Index w = 0; w < model.walls.size(); ++w) {
    if (!model.walls[w].body || !state.walls[w].present) continue;
    const double limit = limit_of_body(model, state, work, w);
    if (limit < step.dt) step = {limit, -1, false, 0};
  }
  step.dt *= model.time_step.safety;

  const Pace pace = pace_of(model, state, work);
  const StableStep kinematic = kinematic_step(model, pace);
  if (kinematic.dt < step.dt) step = kinematic;
  step.steps = steps_for(model.time_step, pace, step.dt);
  return step;
}

/// Differential density scaling, as plan_steps has it.
void scale_inertias(const Model& model, State& state, const Workspace& work,
                    const std::vector<DiagonalStiffness>& stiffness) {
  Clumps& c = state.clumps;
  if (c.id.empty()) return;
  std::vector<double> own(c.id.size());  // limits of the stones' true masses [s]
  for_each_by_runs(own.size(), [&](Index k) {
    own[k] = limit_of_clump(model, state, work, k, stiffness[k]) * std::sqrt(c.mass[k] / c.inertial_mass[k]);
  });
  std::vector<double> sorted = own;
  const auto common = sorted.begin() + static_cast<std::ptrdiff_t>(model.scaled_share *
                                                                   static_cast<double>(sorted.size() - 1));
  std::nth_element(sorted.begin(), common, sorted.end());
  // A contact that opens and closes must not make a stone heavy and light by turns.
  constexpr double most = 2;
  for_each_by_runs(own.size(), [&](Index k) {
    const double now = c.inertial_mass[k] / c.mass[k];
    const double wanted = std::max(1.0, std::pow(*common / own[k], 2));
    if (wanted != now) scale_inertia(state, static_cast<int>(k), std::clamp(wanted / now, 1.0 / most, most));
  });
}

/// The rule.
StepPlan plan(const Model& model, const State& state, const StableStep& stable) {
  const TimeStepRule& rule = model.time_step;
  if (rule.fixed) {
    if (*rule.fixed > stable.dt * (1.0 + 1e-12)) {
      const std::string who =
          stable.clump < 0 ? std::string("a body")
                           : fmt::format("stone {}", state.clumps.id[static_cast<Index>(stable.clump)]);
      throw RunError(fmt::format(
          "the chosen time step {:.3g} s is above the stable one, {:.3g} s, that {} allows by its {}",
          *rule.fixed, stable.dt, who, stable.is_kinematic ? "speed" : "stiffness"));
    }
    return {*rule.fixed, stable.steps};
  }
  if (state.dt == 0) return {stable.dt, rule.shortest_interval};
  return {std::min(stable.dt, state.dt * std::pow(rule.largest_growth, rule.shortest_interval)),
          stable.steps};
}

}  // namespace

DiagonalStiffness stiffness_of(const Model& model, const State& state, const Workspace& work, int clump) {
  DiagonalStiffness k;
  const Index c = static_cast<Index>(clump);
  const Mat3 axes = state.clumps.orientation[c].toRotationMatrix();
  const auto add_pair = [&](Index pair, bool is_second) {
    const PairPlace place = work.pair_places[pair];
    const PairBlock& block = state.pair_blocks[static_cast<Index>(place.block)];
    visit_pair(model, state, block, block.pairs[static_cast<Index>(place.index)],
               [&](const Touching& t) { add_contact(t, is_second ? t.lever_2 : t.lever_1, axes, k); });
  };
  for (int e = work.first_entry[c]; e < work.first_entry[c + 1]; ++e)
    add_pair(static_cast<Index>(work.entries[static_cast<Index>(e)]), true);
  for (int pair = work.first_pair[c]; pair < work.first_pair[c + 1]; ++pair)
    add_pair(static_cast<Index>(pair), false);
  for (int e = work.first_wall_entry[c]; e < work.first_wall_entry[c + 1]; ++e) {
    const int pair = work.wall_entries[static_cast<Index>(e)];
    const PairPlace place = work.wall_pair_places[static_cast<Index>(pair)];
    const WallBlock& block = state.wall_blocks[static_cast<Index>(place.block)];
    visit_pair(model, state, block, block.pairs[static_cast<Index>(place.index)],
               [&](const Touching& t) { add_contact(t, t.lever_1, axes, k); });
  }
  return k;
}

DiagonalStiffness stiffness_of_wall(const Model& model, const State& state, const Workspace& work, int wall) {
  DiagonalStiffness k;
  const Mat3& axes = work.wall_rotation[static_cast<Index>(wall)];
  visit_wall(model, state, wall, [&](const Touching& t) { add_contact(t, t.lever_2, axes, k); });
  return k;
}

StableStep stable_step(const Model& model, const State& state, const Workspace& work) {
  return stable_step_with(model, state, work,
                          [&](Index c) { return stiffness_of(model, state, work, static_cast<int>(c)); });
}

StepPlan plan_steps(const Model& model, State& state, const Workspace& work) {
  if (model.scaled_share <= 0) return plan(model, state, stable_step(model, state, work));
  const std::vector<DiagonalStiffness> stiffness = stiffnesses_of(model, state, work);
  scale_inertias(model, state, work, stiffness);
  return plan(model, state, stable_step_with(model, state, work, [&](Index c) { return stiffness[c]; }));
}

}  // namespace trackbed
