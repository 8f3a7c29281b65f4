#include "geom/mesh_distance.h"

#include <gtest/gtest.h>

#include <cmath>

#include "base/rng.h"
#include "shapes.h"

namespace trackbed {
namespace {

TEST(mesh_distance, box_inside_and_outside) {
  const Vec3 half(0.5, 1, 1.5);
  const MeshDistance box(testing::box_mesh(2 * half, -half));
  Rng rng(1, "points");
  for (int k = 0; k < 2000; ++k) {
    const Vec3 p(rng.uniform(-3, 3), rng.uniform(-3, 3), rng.uniform(-3, 3));
    const Vec3 beyond = p.cwiseAbs() - half;
    const double outside = beyond.cwiseMax(0).norm(), inside = -std::min(beyond.maxCoeff(), 0.0);
    EXPECT_NEAR(box.depth(p), inside - outside, 1e-12);
  }
}

TEST(mesh_distance, side_is_right_in_a_notch) {
  // A box with its top pushed in to a point below the middle: a re-entrant corner.
  TriangleMesh mesh = testing::box_mesh({2, 2, 2}, {-1, -1, 0});
  mesh.vertices.push_back({0, 0, 0.5});
  std::erase(mesh.facets, std::array<int, 3>{4, 5, 6});
  std::erase(mesh.facets, std::array<int, 3>{5, 7, 6});
  mesh.facets.insert(mesh.facets.end(), {{4, 5, 8}, {5, 7, 8}, {7, 6, 8}, {6, 4, 8}});
  const MeshDistance notched(mesh);
  EXPECT_LT(notched.depth({0, 0, 0.6}), 0);
  EXPECT_GT(notched.depth({0, 0, 0.4}), 0);
  EXPECT_NEAR(notched.depth({0, 0, 0.25}), 0.25, 1e-12);
  EXPECT_LT(notched.depth({0.1, 0, 1.9}), 0);
}

}  // namespace
}  // namespace trackbed
