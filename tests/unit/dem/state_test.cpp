#include "dem/state.h"

#include <gtest/gtest.h>

#include <functional>

#include "scenes/scene.h"

namespace trackbed {
namespace {

using Index = std::size_t;

/// Three balls in a row that press and slide on each other, and on a plane.
Simulation row() {
  scenes::Setting a;
  a.friction = 0.5;
  a.rolling_friction = 0.1;
  a.law = LawKind::linear_rolling;
  Simulation sim = scenes::make_scene(a);
  sim.model.templates.push_back(
      make_clump_template("block", {{{0.01, 0, 0}, 0.02}, {{-0.01, 0, 0}, 0.02}}, 6e-5, {1e-8, 2e-8, 3e-8}));
  scenes::add_plane(sim, Vec3::Zero(), Vec3::UnitZ());
  for (int k = 0; k < 3; ++k)
    scenes::add_ball(sim, {0.0399 * k, 0, 0.0199}, {0, 0.01 * k * k, 0}, {0.1, 0, 0.2 * k});
  sim.changed();
  for (int k = 0; k < 3; ++k) sim.step();
  return sim;
}

TEST(State, AddAndRescale) {
  Simulation sim = row();
  const int c = add_clump(sim.model, sim.state, 1, 2, 0, {{0, 0, 1}, Quat(0, 1, 0, 0)});
  Clumps& s = sim.state.clumps;
  EXPECT_EQ(c, 3);
  EXPECT_EQ(s.id[3], 3);
  EXPECT_NEAR(s.mass[3] / (2650 * 6e-5 * 8), 1, 1e-15);
  EXPECT_LT((s.inertia[3] - 2650 * 32 * Vec3(1e-8, 2e-8, 3e-8)).norm(), 1e-15);
  EXPECT_TRUE(s.velocity[3].isZero() && s.angular_momentum[3].isZero());

  set_motion(sim.state, c, {1, 2, 3}, {4, 5, 6});  // turned half round about x
  EXPECT_LT((s.angular_momentum[3] - s.inertia[3].cwiseProduct(Vec3(4, 5, 6))).norm(), 1e-15);
  rescale(sim.model, sim.state, c, 0.5);
  EXPECT_EQ(s.scale[3], 1);
  EXPECT_NEAR(s.mass[3] / (2650 * 6e-5), 1, 1e-15);
  EXPECT_EQ(s.velocity[3], Vec3(1, 2, 3));
  EXPECT_EQ(s.angular_velocity[3], Vec3(4, 5, 6));
  EXPECT_LT((s.angular_momentum[3] - 2650 * Vec3(4e-8, 10e-8, 18e-8)).norm(), 1e-18);
}

TEST(State, InertiaIsScaledAndWeightIsNot) {
  Simulation sim = row();
  const int c = add_clump(sim.model, sim.state, 1, 2, 0, {{0, 0, 1}, Quat(0, 1, 0, 0)});
  Clumps& s = sim.state.clumps;
  const double mass = s.mass[3];
  const Vec3 inertia = s.inertia[3];
  set_motion(sim.state, c, {1, 2, 3}, {4, 5, 6});
  const Vec3 momentum = s.angular_momentum[3];
  const double kinetic = 0.5 * (mass * 14 + Vec3(4, 5, 6).dot(momentum));

  scale_inertia(sim.state, c, 4);  // heavier: the momentum stays
  EXPECT_EQ(s.mass[3], mass);
  EXPECT_EQ(s.inertial_mass[3], 4 * mass);
  EXPECT_LT((s.velocity[3] - 0.25 * Vec3(1, 2, 3)).norm(), 1e-15);
  EXPECT_LT((s.angular_momentum[3] - momentum).norm(), 1e-15);
  EXPECT_NEAR(s.losses[3].damping, 0.75 * kinetic, 1e-12 * kinetic);

  rescale(sim.model, sim.state, c, 0.5);  // a new size keeps the share
  EXPECT_NEAR(s.inertial_mass[3] / s.mass[3], 4, 1e-15);
  rescale(sim.model, sim.state, c, 2);

  scale_inertia(sim.state, c, 0.5);  // lighter: the speed stays
  EXPECT_LT((s.velocity[3] - 0.25 * Vec3(1, 2, 3)).norm(), 1e-15);
  unscale_inertia(sim.model, sim.state, c);
  EXPECT_EQ(s.inertial_mass[3], s.mass[3]);
  EXPECT_NEAR((s.inertia[3] - inertia).norm(), 0, 1e-15 * inertia.norm());
}

// The others keep their ids, their order, and what their contacts remember.
TEST(State, RemoveKeepsTheOthersMemory) {
  Simulation sim = row();
  const State before = sim.state;
  remove_clumps(sim.state, {0});
  const State& now = sim.state;
  EXPECT_EQ(now.clumps.id, (std::vector<int>{1, 2}));
  EXPECT_EQ(now.clumps.position[1], before.clumps.position[2]);
  EXPECT_EQ(now.clumps.losses.size(), 2u);
  ASSERT_EQ(now.pair_blocks[0].pairs.size(), 1u);
  const ClumpPair p = now.pair_blocks[0].pairs[0];
  EXPECT_EQ(p.i, 0);
  EXPECT_EQ(p.j, 1);
  const Vec3 shear = now.pair_blocks[0].memory[static_cast<Index>(p.first)].shear;
  EXPECT_GT(shear.norm(), 0.01);
  ASSERT_EQ(now.wall_blocks[0].pairs.size(), 2u);
  EXPECT_EQ(now.wall_blocks[0].pairs[1].clump, 1);

  sim.changed();
  const PairBlock& block = sim.state.pair_blocks[0];
  const Vec3 kept = block.memory[static_cast<Index>(block.pairs[0].first)].shear;
  EXPECT_LT((kept - shear).norm(), 1e-14 * shear.norm());
  EXPECT_EQ(add_clump(sim.model, sim.state, 0, 1, 0, {}), 2);
  EXPECT_EQ(sim.state.clumps.id[2], 3);  // not 0, which was another stone
  remove_clumps(sim.state, {2});
  add_clump(sim.model, sim.state, 0, 1, 0, {});
  EXPECT_EQ(sim.state.clumps.id[2], 4);  // the last one was another stone, too
}

TEST(State, HashChangesWithEverythingThatBearsOnTheFuture) {
  const Simulation sim = row();
  using Change = std::function<void(State&)>;
  const auto nudge = [](double& x) { x = std::nextafter(x, 1e300); };
  std::vector<Change> changes = {[](State& s) { ++s.clumps.id[1]; },
                                 [](State& s) { ++s.clumps.shape[1]; },
                                 [](State& s) { ++s.clumps.material[2]; },
                                 [&](State& s) { nudge(s.clumps.scale[2]); },
                                 [&](State& s) { nudge(s.clumps.mass[2]); },
                                 [&](State& s) { nudge(s.clumps.orientation[1].x()); },
                                 [&](State& s) { nudge(s.clumps.losses[0].friction); },
                                 [&](State& s) { nudge(s.clumps.losses[0].rolling); },
                                 [&](State& s) { nudge(s.clumps.losses[0].dashpot); },
                                 [&](State& s) { nudge(s.clumps.losses[0].damping); },
                                 [](State& s) { s.walls[0].present = false; },
                                 [&](State& s) { nudge(s.walls[0].pose.orientation.w()); },
                                 [&](State& s) { nudge(s.walls[0].pose.position.x()); },
                                 [&](State& s) { nudge(s.walls[0].applied_work); },
                                 [&](State& s) { nudge(s.walls[0].boundary_work); },
                                 [&](State& s) { nudge(s.walls[0].damping_loss); },
                                 [&](State& s) { nudge(s.time); },
                                 [&](State& s) { nudge(s.dt); },
                                 [&](State& s) { nudge(s.planned_dt); },
                                 [](State& s) { ++s.step; },
                                 [](State& s) { s.clumps.velocity[0].x() = -s.clumps.velocity[0].x(); }};
  for (auto member : {&Clumps::inertia, &Clumps::position, &Clumps::velocity, &Clumps::angular_momentum,
                      &Clumps::force, &Clumps::moment})
    changes.push_back([=](State& s) { nudge((s.clumps.*member)[2].z()); });
  for (auto member :
       {&WallState::velocity, &WallState::angular_velocity, &WallState::angular_momentum, &WallState::force,
        &WallState::moment, &WallState::applied_force, &WallState::applied_moment})
    changes.push_back([=](State& s) { nudge((s.walls[0].*member).y()); });
  for (auto member : {&ContactMemory::normal, &ContactMemory::shear, &ContactMemory::rolling}) {
    changes.push_back([=](State& s) { nudge((s.pair_blocks[0].memory[0].*member).z()); });
    changes.push_back([=](State& s) { nudge((s.wall_blocks[0].memory[0].points[0].*member).z()); });
  }
  changes.push_back([&](State& s) { nudge(s.pair_blocks[0].memory[0].overlap); });
  ASSERT_TRUE(sim.state.pair_blocks[0].memory[0].touches());
  ASSERT_TRUE(sim.state.wall_blocks[0].memory[0].points[0].touches());
  const std::uint64_t reference = hash(sim.state);
  for (Index k = 0; k < changes.size(); ++k) {
    State state = sim.state;
    EXPECT_EQ(hash(state), reference);
    changes[k](state);
    EXPECT_NE(hash(state), reference) << k;
  }
}

TEST(State, HashIsBlindToCandidatesOutOfTouch) {
  State state = row().state;
  const std::uint64_t reference = hash(state);
  PairBlock& block = state.pair_blocks[0];
  ClumpPair& last = block.pairs.back();
  block.keys.push_back({0, 0});
  block.memory.emplace_back();
  block.memory.back().normal = {1, 0, 0};
  ++last.count;
  EXPECT_EQ(hash(state), reference);
  block.memory.back().overlap = 1e-9;
  EXPECT_NE(hash(state), reference);
}

}  // namespace
}  // namespace trackbed
