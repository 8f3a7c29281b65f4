// Stones that were put down overlapping.
#include "lab/stages/parting.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "scenes/scene.h"

namespace trackbed {
namespace {

// In a bed of 500,000 balls on a floor no stiffer than they are, one small ball was pressed past the floor by
// large ones, and the run was given up.
TEST(Parting, SmallStonePressedPastAFloorOfItsOwnStiffnessComesBack) {
  Simulation sim = scenes::make_scene({});
  scenes::add_plane(sim, Vec3::Zero(), Vec3::UnitZ());
  sim.model.domain = Eigen::AlignedBox3d(Vec3(-1, -1, 0), Vec3(1, 1, 1));
  const int small = scenes::add_ball(sim, {0, 0, 0.005}, Vec3::Zero(), Vec3::Zero(), 0.25);
  for (int k = 0; k < 6; ++k)  // all above the floor, all over each other and the small one
    scenes::add_ball(sim, {0.001 * k, 0.0007 * k * k, 0.0201 + 0.0005 * k});
  Parting parting;
  parting.open(sim);
  double lowest = 1;
  do {
    parting.control(sim);
    sim.step();
    lowest = std::min(lowest, sim.state.clumps.position[static_cast<std::size_t>(small)].z());
  } while (!parting.is_done(sim, 0.01, 10));
  EXPECT_LT(lowest, 0);  // its centre was beyond the plane
  EXPECT_GT(sim.state.clumps.position[static_cast<std::size_t>(small)].z(), 0.0045);
  for (const Vec3& place : sim.state.clumps.position) EXPECT_TRUE(sim.model.domain.contains(place));
}

}  // namespace
}  // namespace trackbed
