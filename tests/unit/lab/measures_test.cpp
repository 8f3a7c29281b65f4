// Measures of scenes whose answers are known.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "geom/primitives.h"
#include "lab/in_touch.h"
#include "lab/measure.h"
#include "lab/measures/measures.h"
#include "lab/room.h"
#include "scenes/scene.h"

namespace trackbed {
namespace {

using scenes::Setting;

double value_of(const Simulation& sim, const std::string& name) {
  for (const Measure& m : measures_of(sim))
    if (m.name == name) return m.value(sim);
  ADD_FAILURE() << "there is no measure called " << name;
  return 0;
}

Setting with_gravity() {
  Setting setting;
  setting.gravity = {0, 0, -9.81};
  setting.damping = 0.7;
  return setting;
}

constexpr double ball_volume = 4.0 / 3.0 * std::numbers::pi * 0.02 * 0.02 * 0.02;  // of the setting [m^3]

/// Two balls on a plane, one above the other, the lower pressed 0.1 mm into the plane, the upper 0.05 mm into
/// it.
Simulation tower() {
  Simulation sim = scenes::make_scene(with_gravity());
  scenes::add_plane(sim, Vec3::Zero(), Vec3::UnitZ());
  scenes::add_ball(sim, {0, 0, 0.0199});
  scenes::add_ball(sim, {0, 0, 0.0199 + 0.03995});
  sim.changed();
  return sim;
}

TEST(Measures, CountOfATower) {
  const Simulation sim = tower();
  EXPECT_EQ(value_of(sim, "stones"), 2);
  EXPECT_EQ(value_of(sim, "pebbles"), 2);
  EXPECT_EQ(value_of(sim, "contacts"), 2);
  EXPECT_EQ(value_of(sim, "contacts_stone"), 1);
  EXPECT_EQ(value_of(sim, "contacts_wall"), 1);
  EXPECT_EQ(value_of(sim, "pairs"), 2);
  EXPECT_EQ(value_of(sim, "coordination_number"), 1.0);
  EXPECT_EQ(value_of(sim, "coordination_number_stones"), 0.5);
  EXPECT_EQ(value_of(sim, "contacts_per_stone"), 1.5);
  EXPECT_EQ(value_of(sim, "neighbours_per_stone"), 1.5);
  EXPECT_EQ(value_of(sim, "rattlers"), 1);  // the upper one
}

TEST(Measures, ForcesOfATower) {
  const Simulation sim = tower();
  // Contact stiffness 1e6 N/m: 100 N on the plane, 50 N between the balls.
  EXPECT_NEAR(value_of(sim, "contact_force_max"), 100.0, 1e-9);
  EXPECT_NEAR(value_of(sim, "contact_force_mean"), 75.0, 1e-9);
  EXPECT_NEAR(value_of(sim, "plane.force_z"), -100.0, 1e-9);
  EXPECT_NEAR(value_of(sim, "weight_borne"), 100.0 / value_of(sim, "weight"), 1e-9);
  EXPECT_NEAR(value_of(sim, "largest_overlap"), 0.1 / 20.0, 1e-12);
  EXPECT_EQ(force_histogram(sim, {60, 100.5}), (std::vector<int>{1, 1, 0}));
  EXPECT_EQ(force_histogram(sim, {10}), (std::vector<int>{0, 2}));
  EXPECT_EQ(force_histogram(sim, {}), (std::vector<int>{2}));
}

TEST(Measures, ContactsAreCountedByForceAndByWall) {
  Simulation sim = tower();
  EXPECT_EQ(value_of(sim, "plane.contacts"), 1);
  EXPECT_NEAR(value_of(sim, "plane.contact_force_mean"), 100.0, 1e-9);
  EXPECT_NEAR(value_of(sim, "plane.contact_force_max"), 100.0, 1e-9);
  sim.force_limits = {20, 60.5, 80};
  EXPECT_EQ(value_of(sim, "contacts_below_20_N"), 0);
  EXPECT_EQ(value_of(sim, "contacts_20_60.5_N"), 1);  // between the balls
  EXPECT_EQ(value_of(sim, "contacts_60.5_80_N"), 0);
  EXPECT_EQ(value_of(sim, "contacts_above_80_N"), 1);
  scenes::add_plane(sim, {0, 0, -1}, Vec3::UnitZ());
  EXPECT_EQ(measures_of(sim).back().value(sim), 0);  // nothing touches it, and its mean is no 0/0
  for (const Measure& m : measures_of(sim)) EXPECT_TRUE(std::isfinite(m.value(sim))) << m.name;
}

TEST(Measures, TwoPebblesOfOnePairAreTwoContactsAndOnePair) {
  Simulation sim = scenes::make_scene(with_gravity());
  sim.model.templates.push_back(make_clump_template("dumbbell", {{{-0.02, 0, 0}, 0.02}, {{0.02, 0, 0}, 0.02}},
                                                    2 * ball_volume, {1e-9, 2e-9, 2e-9}));
  for (double z : {0.0, 0.0399}) scenes::add_ball(sim, {0, 0, z}, Vec3::Zero(), Vec3::Zero(), 1.0, 1);
  sim.changed();
  EXPECT_EQ(value_of(sim, "contacts"), 2);
  EXPECT_EQ(value_of(sim, "pairs"), 1);
  EXPECT_EQ(value_of(sim, "contacts_per_stone"), 2);
  EXPECT_EQ(value_of(sim, "neighbours_per_stone"), 1);
  EXPECT_EQ(value_of(sim, "pebbles"), 4);
  scenes::add_plane(sim, {0, 0, -0.0199}, Vec3::UnitZ());
  sim.changed();
  EXPECT_EQ(value_of(sim, "contacts_stone"), 2);
  EXPECT_EQ(value_of(sim, "contacts_wall"), 2);
  EXPECT_EQ(value_of(sim, "pairs"), 2);
  EXPECT_EQ(pairs_in_touch(sim).size(), 2u);
}

TEST(Measures, MeanStressIsThatOfTheForcesOnTheStone) {
  const Simulation sim = tower();
  const std::vector<StoneContacts> stones = contacts_of_stones(sim);
  // A third of sum(F x lever)/V; levers end in the middle of the overlap.
  EXPECT_NEAR(stones[0].mean_stress, (100 * 0.01995 + 50 * 0.019975 - 100 * 0.0) / (3 * ball_volume), 3.0e3);
  EXPECT_NEAR(stones[1].mean_stress, 50 * 0.019975 / (3 * ball_volume), 1e-6);
  EXPECT_EQ(stones[0].neighbours, 2);
}

TEST(Measures, ABallAtRestIsCarriedByThePlane) {
  Simulation sim = scenes::make_scene(with_gravity());
  scenes::add_plane(sim, Vec3::Zero(), Vec3::UnitZ());
  scenes::add_ball(sim, {0, 0, 0.0201});
  scenes::run_until(sim, 0.3);
  const double expected = 2650 * ball_volume * 9.81;
  EXPECT_NEAR(value_of(sim, "weight"), expected, 1e-9);
  EXPECT_NEAR(value_of(sim, "plane.force_z"), -expected, 1e-6 * expected);
  EXPECT_LT(value_of(sim, "unbalanced_ratio"), 1e-5);
  EXPECT_LT(value_of(sim, "energy_kinetic"), 1e-12);
  EXPECT_GT(value_of(sim, "loss_damping"), 0);
  EXPECT_NEAR(value_of(sim, "weight_borne"), 1, 1e-6);
  scenes::add_ball(sim, {0, 0, 1});  // in the air
  sim.changed();
  EXPECT_NEAR(value_of(sim, "weight_borne"), 0.5, 1e-6);
}

TEST(Measures, BedOfBallsOnASquareGrid) {
  Simulation sim = scenes::make_scene(with_gravity());
  sim.container = {Vec3(0, 0, 0), Vec3(0.4, 0.4, 0.3)};
  EXPECT_EQ(porosity(sim, solid_volume(sim)), 1.0);
  for (int k = 0; k < 10; ++k)
    for (int j = 0; j < 10; ++j)
      for (int i = 0; i < 5; ++i) scenes::add_ball(sim, {0.02 + 0.04 * k, 0.02 + 0.04 * j, 0.02 + 0.04 * i});
  sim.changed();
  // The 20 mm grid meets every ball of the top layer 10 mm from its middle in x and y: all heights are alike.
  const double height = 0.18 + std::sqrt(0.02 * 0.02 - 2 * 0.01 * 0.01);
  EXPECT_NEAR(bed_height(sim), height, 1e-12);
  EXPECT_NEAR(porosity(sim, solid_volume(sim)), 1 - 500 * ball_volume / (0.16 * height), 1e-12);
  EXPECT_NEAR(value_of(sim, "d50"), 0.04, 1e-12);
}

TEST(Measures, ABedMayLieBelowZero) {
  Simulation sim = scenes::make_scene(with_gravity());
  sim.container = {Vec3(0, 0, -0.4), Vec3(0.4, 0.4, 0)};
  EXPECT_NEAR(bed_height(sim), -0.4, 1e-12);
  for (int k = 0; k < 10; ++k)
    for (int j = 0; j < 10; ++j) scenes::add_ball(sim, {0.02 + 0.04 * k, 0.02 + 0.04 * j, -0.38});
  const double height = std::sqrt(2e-4) + 0.02;
  EXPECT_NEAR(bed_height(sim), height - 0.4, 1e-12);
  EXPECT_NEAR(porosity(sim, solid_volume(sim)), 1 - 100 * ball_volume / (0.16 * height), 1e-12);
}

TEST(Measures, ASideThatMovesTakesTheContainerWithIt) {
  Simulation sim = scenes::make_scene(with_gravity());
  sim.container = sim.model.domain = {Vec3(0, 0, 0), Vec3(0.4, 0.4, 0.3)};
  const int floor = scenes::add_plane(sim, Vec3::Zero(), Vec3::UnitZ());
  sim.sides = {{floor, 2, false}};
  for (int k = 0; k < 10; ++k)
    for (int j = 0; j < 10; ++j) scenes::add_ball(sim, {0.02 + 0.04 * k, 0.02 + 0.04 * j, 0.02});
  const auto w = static_cast<std::size_t>(floor);
  sim.state.walls[w].pose.position.z() = -0.02;
  sim.drive(w, Vec3::Zero());
  EXPECT_EQ(container_now(sim).min(), Vec3(0, 0, -0.02));
  EXPECT_EQ(sim.model.domain.min(), Vec3(0, 0, -0.02));
  EXPECT_EQ(sim.model.domain.max(), Vec3(0.4, 0.4, 0.3));
  const double height = std::sqrt(2e-4) + 0.02;
  EXPECT_NEAR(bed_height(sim), height, 1e-12);
  EXPECT_NEAR(porosity(sim, solid_volume(sim)), 1 - 100 * ball_volume / (0.16 * (height + 0.02)), 1e-12);
}

TEST(Measures, PorosityOfASlopeCountsWhatLiesBelowItAlone) {
  Simulation sim = scenes::make_scene(with_gravity());
  sim.container = {Vec3(0, 0, 0), Vec3(0.8, 0.4, 0.3)};
  const auto height_of = [](int layers) { return 0.04 * layers - 0.02 + std::sqrt(2e-4); };
  double volume = 0;
  for (int step = 0; step < 4; ++step) {  // 200 mm long each, one layer higher than the one before it
    for (int k = 0; k < 5; ++k)
      for (int j = 0; j < 10; ++j)
        for (int i = 0; i <= step; ++i)
          scenes::add_ball(sim, {0.2 * step + 0.02 + 0.04 * k, 0.02 + 0.04 * j, 0.02 + 0.04 * i});
    volume += 0.2 * 0.4 * height_of(step + 1);
  }
  EXPECT_NEAR(porosity(sim, solid_volume(sim)), 1 - 500 * ball_volume / volume, 1e-12);
  // A sleeper across the highest step, sunk into it to half of its height.
  const Vec3 place(0.7, 0.2, height_of(4));
  add_wall(
      sim,
      {make_mesh_wall("sleeper", box_mesh({0.1, 0.4, 0.05}, {-0.05, -0.2, -0.025})), 0, BodyProperties{}},
      {place, Quat::Identity()});
  volume -= 0.1 * 0.4 * 0.025;
  EXPECT_NEAR(porosity(sim, solid_volume(sim)), 1 - 500 * ball_volume / volume, 1e-12);
}

TEST(Measures, ABodyInTheBedIsNeitherStoneNorPore) {
  Simulation sim = scenes::make_scene(with_gravity());
  sim.container = {Vec3(0, 0, 0), Vec3(0.4, 0.4, 0.3)};
  for (int k = 0; k < 10; ++k)
    for (int j = 0; j < 10; ++j) scenes::add_ball(sim, {0.02 + 0.04 * k, 0.02 + 0.04 * j, 0.02});
  const int body = add_wall(
      sim,
      {make_mesh_wall("sleeper", box_mesh({0.1, 0.1, 0.01}, {-0.05, -0.05, -0.005})), 0, BodyProperties{}},
      {{0.2, 0.2, 0.034}, Quat::Identity()});
  const double height = bed_height(sim);
  const double without = 1 - 100 * ball_volume / (0.16 * height - 0.01 * (height - 0.029));
  EXPECT_NEAR(porosity(sim, solid_volume(sim)), without, 1e-12);
  sim.state.walls[static_cast<std::size_t>(body)].present = false;
  EXPECT_NEAR(porosity(sim, solid_volume(sim)), 1 - 100 * ball_volume / (0.16 * height), 1e-12);
}

TEST(Measures, VolumeOfABodyBelowALevel) {
  const WallShape box = make_mesh_wall("box", box_mesh({0.2, 0.3, 0.4}, {-0.1, -0.15, -0.2}));
  const Pose pose{{1, 2, 3}, Quat::Identity()};
  EXPECT_NEAR(volume_below(box, pose, 2.7), 0.0, 1e-15);
  EXPECT_NEAR(volume_below(box, pose, 2.9), 0.2 * 0.3 * 0.1, 1e-15);
  EXPECT_NEAR(volume_below(box, pose, 3.5), 0.2 * 0.3 * 0.4, 1e-15);
  // Half of a box in any orientation lies below its centre.
  const Pose turned{{1, 2, 3}, Quat(0.5, 0.1, -0.7, 0.2).normalized()};
  EXPECT_NEAR(volume_below(box, turned, 3.0), 0.5 * 0.2 * 0.3 * 0.4, 1e-15);
}

TEST(Measures, TheStoneThatMovedMostIsFoundByItsId) {
  Simulation sim = tower();
  sim.places = places_of(sim.state);
  EXPECT_EQ(value_of(sim, "stone_displacement_max"), 0);
  sim.state.clumps.position[0] += Vec3(0.001, 0, 0);
  sim.state.clumps.position[1] += Vec3(0, 0.003, 0.004);
  EXPECT_NEAR(value_of(sim, "stone_displacement_max"), 0.005, 1e-15);
  remove_clumps(sim.state, {1});
  EXPECT_NEAR(value_of(sim, "stone_displacement_max"), 0.001, 1e-15);
}

TEST(Measures, WallsTellHowFarTheyHaveGone) {
  Simulation sim = tower();
  sim.state.walls[0].pose.position = {0.01, 0, -0.002};
  EXPECT_NEAR(value_of(sim, "plane.displacement_x"), 0.01, 1e-15);
  EXPECT_NEAR(value_of(sim, "plane.displacement_z"), -0.002, 1e-15);
}

/// A block of 0.3 x 0.1 x 0.2 m on a wedge of 45 degrees along x, with a ball pressed 0.1 mm into its
/// underside's slope, its long side, its end and its top: 100 N each. `turn` is the frame it happens to be
/// in.
Simulation pressed_wedge(const Quat& turn) {
  Simulation sim = scenes::make_scene(with_gravity());
  TriangleMesh mesh = wedge_mesh({0.3, 0.1, 0.2}, std::numbers::pi / 4, 1);
  for (Vec3& v : mesh.vertices) v = turn.conjugate() * v;
  Wall sleeper{make_mesh_wall("sleeper", mesh), 0, BodyProperties{}};
  add_wall(sim, sleeper, {Vec3::Zero(), turn});
  const double away = 0.02 - 1e-4;
  const Vec3 slope(std::sqrt(0.5), 0, -std::sqrt(0.5));
  scenes::add_ball(sim, Vec3(0.075, 0, -0.075) + away * slope);
  scenes::add_ball(sim, {0, 0.05 + away, 0.1});
  scenes::add_ball(sim, {0.15 + away, 0, 0.1});
  scenes::add_ball(sim, {0, 0, 0.2 + away});
  sim.changed();
  return sim;
}

TEST(Measures, ForceOfASleeperIsSplitBetweenItsFaces) {
  for (const Quat& turn : {Quat::Identity(), Quat(Eigen::AngleAxisd(1.1, Vec3(1, 2, 3).normalized()))}) {
    const Simulation sim = pressed_wedge(turn);
    EXPECT_NEAR(value_of(sim, "sleeper.force_slopes_x"), -100 * std::sqrt(0.5), 1e-6);
    EXPECT_NEAR(value_of(sim, "sleeper.force_slopes_z"), 100 * std::sqrt(0.5), 1e-6);
    EXPECT_NEAR(value_of(sim, "sleeper.force_sides_y"), -100, 1e-6);
    EXPECT_NEAR(value_of(sim, "sleeper.force_ends_x"), -100, 1e-6);
    EXPECT_NEAR(value_of(sim, "sleeper.force_base_z"), -100, 1e-6);
    EXPECT_NEAR(value_of(sim, "sleeper.force_base_x"), 0, 1e-6);
  }
}

}  // namespace
}  // namespace trackbed
