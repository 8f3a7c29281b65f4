#include "dem/wall_shape.h"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <cmath>
#include <numeric>

#include "base/error.h"
#include "base/rng.h"
#include "geom/primitives.h"

namespace trackbed {
namespace {

Vec3 any_point(Rng& rng, double size) {
  return {rng.uniform(-size, size), rng.uniform(-size, size), rng.uniform(-size, size)};
}

/// Nearest point of a triangle by golden-section search along u of the golden-section search along v of
/// |a + u (b - a) + v (c - a) - p|: the distance is convex.
double searched_distance(const Facet& f, const Vec3& p) {
  const auto least = [](auto&& function, double low, double high) {
    const double g = (std::sqrt(5.0) - 1) / 2;
    double x = high - g * (high - low), y = low + g * (high - low);
    double fx = function(x), fy = function(y);
    for (int k = 0; k < 45; ++k) {
      if (fx < fy) {
        high = y, y = x, fy = fx, x = high - g * (high - low), fx = function(x);
      } else {
        low = x, x = y, fx = fy, y = low + g * (high - low), fy = function(y);
      }
    }
    return std::min({fx, fy, function(low), function(high)});
  };
  const auto across = [&](double u) {
    return least([&](double v) { return (f.a + u * (f.b - f.a) + v * (f.c - f.a) - p).norm(); }, 0, 1 - u);
  };
  return least(across, 0, 1);
}

RC_GTEST_PROP(ClosestPoint, AsABruteForceSearchFindsIt, (std::uint64_t seed)) {
  Rng rng(seed, "closest point");
  Facet f{any_point(rng, 1), any_point(rng, 1), any_point(rng, 1), Vec3::Zero(), 0};
  const Vec3 across = (f.b - f.a).cross(f.c - f.a);
  const double area2 = across.norm();
  RC_PRE(area2 > 1e-2);
  f.normal = across / area2;
  const Vec3 p = any_point(rng, 2);
  const Vec3 q = closest_point(f, p);
  RC_ASSERT(std::abs((q - p).norm() - searched_distance(f, p)) < 1e-8);
  RC_ASSERT(!f.is_beyond(p, (q - p).norm() + 1e-12));
  // It lies on the triangle: its barycentric coordinates add up and none is negative.
  const double u = (f.b - q).cross(f.c - q).norm(), v = (f.c - q).cross(f.a - q).norm(),
               w = (f.a - q).cross(f.b - q).norm();
  RC_ASSERT(std::abs(u + v + w - area2) < 1e-12);
}

TEST(ClosestPoint, CornersEdgesAndFace) {
  const Facet f{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, Vec3::UnitZ(), 0};
  EXPECT_FALSE(f.is_beyond({5, 5, -2}, 2));
  EXPECT_TRUE(f.is_beyond({5, 5, -2}, 1.99));
  EXPECT_EQ(closest_point(f, {-1, -1, 2}), f.a);
  EXPECT_EQ(closest_point(f, {2, -0.5, -2}), f.b);
  EXPECT_EQ(closest_point(f, {-0.5, 2, 0}), f.c);
  EXPECT_EQ(closest_point(f, {0.25, -3, 1}), Vec3(0.25, 0, 0));
  EXPECT_EQ(closest_point(f, {-3, 0.75, 1}), Vec3(0, 0.75, 0));
  EXPECT_LT((closest_point(f, {1, 1, 5}) - Vec3(0.5, 0.5, 0)).norm(), 1e-15);
  EXPECT_EQ(closest_point(f, {0.25, 0.5, -7}), Vec3(0.25, 0.5, 0));
}

/// Touching points, all facets looked at.
std::vector<WallPoint> touching(const WallShape& shape, const Vec3& centre, double radius) {
  std::vector<int> all(shape.facets.size());
  std::iota(all.begin(), all.end(), 0);
  WallPoints points;
  const int n = touching_points(shape, all.data(), static_cast<int>(all.size()), centre, radius, points);
  return {points.begin(), points.begin() + n};
}

TEST(TouchingPoints, OutsideACubeThereIsOneWherever) {
  const WallShape cube = make_mesh_wall("cube", box_mesh(Vec3::Ones()));
  const struct {
    Vec3 centre, point;
  } cases[] = {{{0.5, 0.5, 1.09}, {0.5, 0.5, 1}},  // on the diagonal of a face
               {{0.3, 0.4, 1.09}, {0.3, 0.4, 1}},  // within a facet
               {{0.5, -0.05, 1.05}, {0.5, 0, 1}},  // on an edge
               {{0.5, -1e-7, 1.09}, {0.5, 0, 1}},  // a hair beyond it
               {{1.04, -0.04, 1.04}, {1, 0, 1}},   // on a corner
               {{1.0, 0.0, 1.09}, {1, 0, 1}}};     // straight above it
  for (const auto& c : cases) {
    const auto points = touching(cube, c.centre, 0.1);
    ASSERT_EQ(points.size(), 1u) << c.centre.transpose();
    EXPECT_LT((points[0].point - c.point).norm(), 1e-14) << c.centre.transpose();
    EXPECT_NEAR(points[0].distance, (c.centre - c.point).norm(), 1e-14);
    const Facet& f = cube.facets[static_cast<std::size_t>(points[0].facet)];
    EXPECT_LT((closest_point(f, c.point) - c.point).norm(), 1e-14);
  }
  EXPECT_TRUE(touching(cube, {0.5, 0.5, 1.1}, 0.1).empty());
  EXPECT_TRUE(touching(cube, {0.5, 0.5, 0.5}, 0.1).empty());
}

TEST(TouchingPoints, InsideACubeThereIsOneAFace) {
  const WallShape cube = make_mesh_wall("cube", box_mesh(Vec3::Ones()));
  EXPECT_EQ(touching(cube, {0.5, 0.5, 0.09}, 0.1).size(), 1u);
  EXPECT_EQ(touching(cube, {0.5, 0.08, 0.09}, 0.1).size(), 2u);
  const auto corner = touching(cube, {0.07, 0.08, 0.09}, 0.1);
  ASSERT_EQ(corner.size(), 3u);  // nearest first
  EXPECT_LT((corner[0].point - Vec3(0, 0.08, 0.09)).norm(), 1e-14);
  EXPECT_LT((corner[1].point - Vec3(0.07, 0, 0.09)).norm(), 1e-14);
  EXPECT_LT((corner[2].point - Vec3(0.07, 0.08, 0)).norm(), 1e-14);
}

TEST(TouchingPoints, APlaneIsMetFromAboveHoweverDeep) {
  const WallShape plane = make_plane_wall("plane", 1);
  EXPECT_TRUE(touching(plane, {3, 4, 0.1}, 0.1).empty());
  const auto above = touching(plane, {3, 4, 0.09}, 0.1);
  ASSERT_EQ(above.size(), 1u);
  EXPECT_EQ(above[0].point, Vec3(3, 4, 0));
  EXPECT_EQ(above[0].distance, 0.09);
  ASSERT_EQ(touching(plane, {3, 4, -0.05}, 0.1).size(), 1u);
  EXPECT_EQ(touching(plane, {3, 4, -0.05}, 0.1)[0].distance, -0.05);
}

// In a valley both faces press; over a ridge, however flat, the edge alone.
TEST(TouchingPoints, ValleyAndRidge) {
  for (double slope : {0.02, 0.1, 0.5, 1.0}) {
    const auto roof = [&](double height) {
      return make_mesh_wall(
          "roof",
          {{{0, -1, 0}, {0, 1, 0}, {1, -1, height}, {1, 1, height}, {-1, -1, height}, {-1, 1, height}},
           {{0, 2, 3}, {0, 3, 1}, {0, 1, 5}, {0, 5, 4}}});
    };
    EXPECT_EQ(touching(roof(slope), {0, 0.1, 0.09}, 0.1).size(), 2u) << slope;
    EXPECT_EQ(touching(roof(-slope), {0, 0.1, 0.09}, 0.1).size(), 1u) << slope;
  }
}

TEST(MeshWall, KeepsGroupsAndRefusesFacetsWithoutArea) {
  const TriangleMesh box = box_mesh(Vec3(1, 2, 3), Vec3(-0.5, -1, -1.5));
  std::vector<int> groups;
  for (int k = 0; k < 12; ++k) groups.push_back(k / 2);
  const WallShape wall = make_mesh_wall("box", box, groups);
  EXPECT_NEAR(wall.reach, 0.5 * std::sqrt(14.0), 1e-15);
  ASSERT_EQ(wall.facets.size(), 12u);
  for (std::size_t k = 0; k < 12; ++k) {
    const std::size_t of_user = static_cast<std::size_t>(wall.tree.order()[k]);
    EXPECT_EQ(wall.facets[k].group, groups[of_user]);
    EXPECT_EQ(wall.facets[k].a, box.corners(of_user)[0]);
  }
  EXPECT_THROW(make_mesh_wall("none", {}), InputError);
  EXPECT_THROW(make_mesh_wall("thin", {{{0, 0, 0}, {1, 0, 0}, {2, 0, 0}}, {{0, 1, 2}}}), InputError);
}

}  // namespace
}  // namespace trackbed
