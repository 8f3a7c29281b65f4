#include "geom/stone.h"

#include <gtest/gtest.h>

#include <cmath>

#include "base/rng.h"
#include "geom/mass_properties.h"
#include "geom/stone_generator.h"
#include "shapes.h"

namespace trackbed {
namespace {

TEST(stone, box_has_the_mass_properties_of_its_mesh_in_its_own_frame) {
  Rng rng(2, "turn");
  const TriangleMesh box = testing::turned(testing::box_mesh({3, 2, 1}), rng.rotation(), {5, 6, 7});
  const Stone stone = make_stone(box, "box", {});
  EXPECT_NEAR(stone.clump.volume, 6, 1e-9);
  EXPECT_TRUE(
      stone.clump.inertia.isApprox(Vec3(6 * (4 + 1) / 12.0, 6 * (9 + 1) / 12.0, 6 * (9 + 4) / 12.0), 1e-9));
  const MassProperties moved = mass_properties(stone.clump.surface);
  EXPECT_LT(moved.centre.norm(), 1e-9);
  EXPECT_NEAR(stone.clump.sieve_size, 2, 0.01);
  EXPECT_GT(stone.error.volume_ratio, 0.93);
  EXPECT_LT(stone.error.volume_ratio, 1.02);
  // Pebbles lie inside the box of the principal frame: x along the longest side.
  for (const Pebble& p : stone.clump.pebbles)
    for (Eigen::Index k = 0; k < 3; ++k)
      EXPECT_LT(std::abs(p.centre[k]) + p.radius / 1.05, (3.0 - static_cast<double>(k)) / 2 + 1e-9);
}

TEST(stone, error_falls_as_distance_grows) {
  const TriangleMesh mesh = generate_stone({}, 1, 0);
  double last = 1;
  for (double degrees : {90., 120., 150., 165.}) {
    ClumpFilling filling;
    filling.distance = degrees * std::numbers::pi / 180;
    filling.ratio = 0.2;
    const Stone stone = make_stone(mesh, "made", filling);
    EXPECT_LT(stone.error.mean_distance, last);
    last = stone.error.mean_distance;
  }
}

TEST(stone, enlarged_pebbles_fill_the_volume_of_the_stone_and_leave_its_mass) {
  const TriangleMesh mesh = generate_stone({}, 1, 0);
  ClumpFilling filling;
  filling.ratio = 0.8;
  const Stone inside = make_stone(mesh, "made", filling);
  filling.enlarge = true;
  const Stone enlarged = make_stone(mesh, "made", filling);
  EXPECT_LT(inside.error.volume_ratio, 0.8);
  EXPECT_NEAR(enlarged.error.volume_ratio, 1, 2e-3);  // each ratio is good to 0.1 %
  EXPECT_EQ(enlarged.clump.volume, inside.clump.volume);
  EXPECT_EQ(enlarged.clump.inertia, inside.clump.inertia);
  ASSERT_EQ(enlarged.clump.pebbles.size(), inside.clump.pebbles.size());
  const double scale = std::cbrt(1 / inside.error.volume_ratio);
  EXPECT_NEAR(enlarged.clump.bounding_radius, scale * inside.clump.bounding_radius,
              1e-12 * inside.clump.bounding_radius);
}

TEST(stone, thousands_of_pebbles_are_reached) {
  const TriangleMesh mesh = generate_stone({}, 1, 0);
  ClumpFilling filling;
  filling.distance = 170 * std::numbers::pi / 180;
  filling.ratio = 0.1;
  filling.max_pebbles = 5000;
  EXPECT_EQ(make_stone(mesh, "made", filling).clump.pebbles.size(), 5000u);
}

}  // namespace
}  // namespace trackbed
