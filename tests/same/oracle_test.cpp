// The engine's contact forces against a second, plain answer: every pebble with every pebble and plane, no
// search, the law written down once more with a memory of its own. Rounding leaves 3e-13 of the largest
// force.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <map>

#include "base/rng.h"
#include "scenes/scene.h"

namespace trackbed {
namespace {

using Index = std::size_t;

/// A rigid body at a point in time.
struct Body {
  Vec3 place, velocity, spin;
  Vec3 velocity_at(const Vec3& point) const { return velocity + spin.cross(point - place); }
};

struct Load {
  Vec3 force = Vec3::Zero(), moment = Vec3::Zero();
};

struct Spring {
  Vec3 normal, shear, rolling;
};

/// Where two bodies press on each other; the normal points from the first to the second.
struct Press {
  Vec3 point, normal;
  double overlap, radius, reduced_mass;
};

/// Follows a simulation by its positions and velocities alone; to be asked after every step.
class Oracle {
 public:
  std::vector<Load> clumps, walls;
  int begun = 0, ended = 0, slipped = 0, stuck = 0, rolled = 0;

  void follow(const Simulation& sim) {
    clumps.assign(sim.state.clumps.id.size(), {});
    walls.assign(sim.state.walls.size(), {});
    std::map<Key, Spring> before;
    before.swap(springs_);
    before_ = &before;
    place_pebbles(sim);
    for (Index i = 0; i < clumps.size(); ++i) {
      for (Index j = i + 1; j < clumps.size(); ++j) clump_on_clump(sim, i, j);
      for (Index w = 0; w < walls.size(); ++w) clump_on_plane(sim, i, w);
    }
    for (const auto& [key, spring] : before) ended += springs_.count(key) == 0;
  }

 private:
  using Key = std::array<int, 4>;  // clump, pebble, clump or -1 - wall, pebble
  std::map<Key, Spring> springs_;
  const std::map<Key, Spring>* before_ = nullptr;
  std::vector<std::vector<Pebble>> pebbles_;  // in the world

  void place_pebbles(const Simulation& sim) {
    const Clumps& c = sim.state.clumps;
    pebbles_.assign(clumps.size(), {});
    for (Index i = 0; i < clumps.size(); ++i)
      for (const Pebble& p : sim.model.templates[static_cast<Index>(c.shape[i])].pebbles)
        pebbles_[i].push_back(
            {c.position[i] + c.orientation[i] * (c.scale[i] * p.centre), c.scale[i] * p.radius});
  }

  static Body body(const Clumps& c, Index i) { return {c.position[i], c.velocity[i], c.angular_velocity[i]}; }

  void clump_on_clump(const Simulation& sim, Index i, Index j) {
    const Clumps& c = sim.state.clumps;
    for (Index a = 0; a < pebbles_[i].size(); ++a)
      for (Index b = 0; b < pebbles_[j].size(); ++b) {
        const Pebble &p = pebbles_[i][a], &q = pebbles_[j][b];
        const double distance = (q.centre - p.centre).norm();
        if (distance >= p.radius + q.radius) continue;
        Press press;
        press.normal = (q.centre - p.centre) / distance;
        press.overlap = p.radius + q.radius - distance;
        press.point = p.centre + (p.radius - press.overlap / 2) * press.normal;
        press.radius = 1 / (1 / p.radius + 1 / q.radius);
        press.reduced_mass = 1 / (1 / c.mass[i] + 1 / c.mass[j]);
        const Key key{static_cast<int>(i), static_cast<int>(a), static_cast<int>(j), static_cast<int>(b)};
        respond(key, press, sim.model.pairs(c.material[i], c.material[j]), sim.state.dt, body(c, i),
                body(c, j), clumps[i], clumps[j]);
      }
  }

  void clump_on_plane(const Simulation& sim, Index i, Index w) {
    const Clumps& c = sim.state.clumps;
    const WallState& wall = sim.state.walls[w];
    const Vec3 up = wall.pose.orientation * Vec3::UnitZ();
    for (Index a = 0; a < pebbles_[i].size(); ++a) {
      const Pebble& p = pebbles_[i][a];
      const double height = (p.centre - wall.pose.position).dot(up);
      if (height >= p.radius) continue;
      Press press;
      press.normal = -up;
      press.overlap = p.radius - height;
      press.point = p.centre - (p.radius - press.overlap / 2) * up;
      press.radius = p.radius;
      press.reduced_mass = c.mass[i];
      respond({static_cast<int>(i), static_cast<int>(a), -1 - static_cast<int>(w), 0}, press,
              sim.model.pairs(c.material[i], sim.model.walls[w].material), sim.state.dt, body(c, i),
              {wall.pose.position, wall.velocity, wall.angular_velocity}, clumps[i], walls[w]);
    }
  }

  /// Cuts v to the given length; says whether that was needed.
  static bool cut(Vec3& v, double length) {
    if (v.norm() <= length) return false;
    v = length * v.normalized();
    return true;
  }

  static Vec3 across(const Vec3& v, const Vec3& n) { return v - n * n.dot(v); }

  void respond(const Key& key, const Press& press, const ContactProperties& p, double dt, const Body& one,
               const Body& two, Load& on_one, Load& on_two) {
    const Vec3& n = press.normal;
    const Vec3 velocity = two.velocity_at(press.point) - one.velocity_at(press.point);
    const double closing = -velocity.dot(n);
    Spring spring{n, Vec3::Zero(), Vec3::Zero()};
    double time = dt;  // in touch during this step
    if (const auto old = before_->find(key); old != before_->end()) {
      const Eigen::AngleAxisd twist(0.5 * (one.spin + two.spin).dot(n) * dt, n);
      const Quat turn = twist * Quat::FromTwoVectors(old->second.normal, n);
      spring.shear = turn * old->second.shear;
      spring.rolling = turn * old->second.rolling;
    } else {
      ++begun;
      if (closing * dt > press.overlap) time = press.overlap / closing;
    }

    const double normal_force = p.kn * press.overlap;
    spring.shear -= p.ks * time * across(velocity, n);
    const bool slips = cut(spring.shear, p.friction * normal_force);
    ++(slips ? slipped : stuck);
    if (p.law == LawKind::linear_rolling) {
      const double stiffness = p.ks * press.radius * press.radius;
      spring.rolling -= stiffness * time * across(two.spin - one.spin, n);
      rolled += cut(spring.rolling, p.rolling_friction * press.radius * normal_force);
    }

    const bool may_pull = p.dashpot.mode == DashpotMode::full || p.dashpot.mode == DashpotMode::full_slip_cut;
    const bool slip_cut =
        p.dashpot.mode == DashpotMode::full_slip_cut || p.dashpot.mode == DashpotMode::no_tension_slip_cut;
    double viscous = 2 * p.dashpot.normal * std::sqrt(press.reduced_mass * p.kn) * closing;
    if (!may_pull && viscous < -normal_force) viscous = -normal_force;
    Vec3 force = (normal_force + viscous) * n + spring.shear;
    if (!(slip_cut && slips))
      force -= 2 * p.dashpot.shear * std::sqrt(press.reduced_mass * p.ks) * across(velocity, n);

    on_two.force += force;
    on_two.moment += (press.point - two.place).cross(force) + spring.rolling;
    on_one.force -= force;
    on_one.moment -= (press.point - one.place).cross(force) + spring.rolling;
    springs_[key] = spring;
  }
};

/// Twelve stones of 8 to 20 pebbles and two materials, thrown spinning into a closed box of planes.
Simulation thrown_stones(const scenes::Setting& setting, std::uint64_t seed) {
  Simulation sim = scenes::make_scene(setting);
  Model& m = sim.model;
  m.materials.push_back({"steel", 8 * setting.kn, 4 * setting.ks, 0.5 * setting.friction,
                         0.5 * setting.rolling_friction, setting.density});
  m.pairs = PairTable(m.materials, setting.law, setting.dashpot);
  Rng rng(seed, "oracle");
  for (int n : {8, 13, 20}) {
    std::vector<Pebble> pebbles;
    for (int k = 0; k < n; ++k)
      pebbles.push_back(
          {rng.uniform(0.008, 0.014) * (rng.rotation() * Vec3::UnitX()), rng.uniform(0.004, 0.009)});
    m.templates.push_back(make_clump_template("lump", pebbles, 2.5e-5, {1e-9, 1.3e-9, 1.7e-9}));
  }
  for (const Vec3& side :
       {Vec3(0, 0, 1), Vec3(0, 0, -1), Vec3(1, 0, 0), Vec3(-1, 0, 0), Vec3(0, 1, 0), Vec3(0, -1, 0)})
    scenes::add_plane(sim, Vec3(0, 0, 0.08) - 0.08 * side, side);
  m.walls[0].material = 1;
  const auto any = [&] { return rng.rotation() * Vec3::UnitX(); };
  for (int k = 0; k < 12; ++k) {
    const Vec3 x(-0.026 + 0.052 * (k % 2), -0.026 + 0.052 * (k / 2 % 2), 0.028 + 0.052 * (k / 4));
    const int c = add_clump(m, sim.state, 1 + k % 3, rng.uniform(0.8, 1.1), k % 4 == 0, {x, rng.rotation()});
    set_motion(sim.state, c, 1.5 * any(), 60 * any());
  }
  return sim;
}

/// Largest difference between engine and oracle over the largest force so far, over `steps` steps; moments
/// are divided by the stones' reach.
double worst_difference(Simulation& sim, Oracle& oracle, int steps) {
  constexpr double reach = 0.02;
  double largest = 0, worst = 0;
  sim.changed();
  EXPECT_EQ(sim.work.touching, 0) << "the oracle must see every contact begin";
  for (int k = 0; k < steps; ++k) {
    sim.step();
    oracle.follow(sim);
    const Clumps& c = sim.state.clumps;
    const auto compare = [&](const Load& load, const Vec3& force, const Vec3& moment, double lever) {
      largest = std::max(largest, force.norm());
      worst = std::max({worst, (load.force - force).norm(), (load.moment - moment).norm() / lever});
    };
    for (Index i = 0; i < c.id.size(); ++i) compare(oracle.clumps[i], c.force[i], c.moment[i], reach);
    for (Index w = 0; w < sim.state.walls.size(); ++w)
      compare(oracle.walls[w], sim.state.walls[w].force, sim.state.walls[w].moment, 0.1);
  }
  EXPECT_GT(largest, 10);
  return worst / largest;
}

TEST(oracle, falling_bed) {
  scenes::Setting a;
  a.friction = 0.5;
  a.damping = 0.3;
  a.gravity = {0, 0, -50};
  for (const Dashpot& dashpot : {Dashpot{}, Dashpot{0.1, 0.2, DashpotMode::no_tension_slip_cut}}) {
    a.dashpot = dashpot;
    Simulation sim = thrown_stones(a, 1);
    Oracle oracle;
    EXPECT_LT(worst_difference(sim, oracle, 15000), 1e-12);
    EXPECT_GT(oracle.begun, 300);
    EXPECT_GT(oracle.ended, 200);
    EXPECT_GT(oracle.slipped, 1000);
    EXPECT_GT(oracle.stuck, 10000);
  }
}

TEST(oracle, falling_bed_with_rolling_resistance) {
  scenes::Setting a;
  a.law = LawKind::linear_rolling;
  a.friction = 0.5;
  a.rolling_friction = 0.1;
  a.damping = 0.3;
  a.dashpot = {0.05, 0.05, DashpotMode::full};
  a.gravity = {0, 0, -50};
  Simulation sim = thrown_stones(a, 2);
  Oracle oracle;
  EXPECT_LT(worst_difference(sim, oracle, 15000), 1e-12);
  EXPECT_GT(oracle.begun, 300);
  EXPECT_GT(oracle.stuck, 10000);
  EXPECT_GT(oracle.rolled, 1000);
  EXPECT_GT(oracle.stuck + oracle.slipped - oracle.rolled, 1000);
}

// Without gravity and damping the stones fly about, meet and part; the floor and a side come in and turn.
TEST(oracle, tumbling_between_moving_walls) {
  scenes::Setting a;
  a.law = LawKind::linear_rolling;
  a.friction = 0.4;
  a.rolling_friction = 0.05;
  Simulation sim = thrown_stones(a, 3);
  sim.state.walls[0].velocity = {0.3, 0, 0.06};
  sim.state.walls[0].angular_velocity = {0.1, 0.2, 5};
  sim.state.walls[2].velocity = {0.06, 0.2, 0};
  Oracle oracle;
  EXPECT_LT(worst_difference(sim, oracle, 20000), 1e-12);
  EXPECT_GT(oracle.begun, 80);
  EXPECT_GT(oracle.ended, 80);
  EXPECT_GT(oracle.slipped, 1000);
  EXPECT_GT(oracle.stuck, 150);
}

}  // namespace
}  // namespace trackbed
