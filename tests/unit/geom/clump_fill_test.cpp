#include "geom/clump_fill.h"

#include <gtest/gtest.h>

#include <chrono>
#include <cmath>

#include "base/error.h"
#include "base/rng.h"
#include "geom/mesh_distance.h"
#include "shapes.h"

namespace trackbed {
namespace {

constexpr double degree = std::numbers::pi / 180;

ClumpFilling filling(double distance, double ratio) {
  ClumpFilling f;
  f.distance = distance * degree;
  f.ratio = ratio;
  return f;
}

std::size_t count(const TriangleMesh& mesh, double distance, double ratio) {
  return fill_with_pebbles(mesh, filling(distance, ratio)).size();
}

/// What every filling promises: pebbles inside but for the radius factor, angles and radii as asked.
void expect_kept_promises(const TriangleMesh& mesh, const ClumpFilling& f) {
  const std::vector<Pebble> pebbles = fill_with_pebbles(mesh, f);
  const MeshDistance surface(mesh);
  for (std::size_t a = 0; a < pebbles.size(); ++a) {
    EXPECT_GE(surface.depth(pebbles[a].centre), pebbles[a].radius / f.radius_factor * (1 - 1e-12));
    EXPECT_GE(pebbles[a].radius, f.ratio * pebbles[0].radius);
    for (std::size_t b = 0; b < a; ++b) {
      const double d = (pebbles[a].centre - pebbles[b].centre).norm();
      EXPECT_GT(d, pebbles[b].radius - pebbles[a].radius);
      EXPECT_LE(angle_between(pebbles[a], pebbles[b]), f.distance + 1e-9);
    }
  }
}

const TriangleMesh cube = testing::box_mesh(Vec3::Ones());

TEST(clump_fill, angle_between_pebbles) {
  const Pebble a{Vec3::Zero(), 1};
  EXPECT_NEAR(angle_between(a, {{3, 0, 0}, 2}), 0, 1e-12);
  EXPECT_NEAR(angle_between(a, {{1, 0, 0}, 2}), std::numbers::pi, 1e-7);
  // Equal spheres on a flat face: spacing = 2 r cos(angle / 2).
  for (double angle : {70., 110., 120., 150.})
    EXPECT_NEAR(angle_between(a, {{2 * std::cos(angle / 2 * degree), 0, 0}, 1}), angle * degree, 1e-12);
}

TEST(clump_fill, sphere_is_one_pebble) {
  const TriangleMesh sphere = testing::icosphere(4, 2);
  for (double distance : {0., 90., 150.})
    for (double ratio : {0.2, 0.5, 1.}) {
      const auto pebbles = fill_with_pebbles(sphere, filling(distance, ratio));
      ASSERT_EQ(pebbles.size(), 1u) << distance << " " << ratio;
      EXPECT_NEAR(pebbles[0].radius, 2, 0.01);
      EXPECT_LT(pebbles[0].centre.norm(), 0.01);
    }
}

TEST(clump_fill, cube_at_distance_0) {
  const auto one = fill_with_pebbles(cube, filling(0, 0.3));
  ASSERT_EQ(one.size(), 1u);
  EXPECT_NEAR(one[0].radius, 0.5, 1e-3);

  ClumpFilling fine = filling(0, 0.2);  // the corner pebbles' radii follow from how close samples lie
  fine.samples = 200'000;
  const auto nine = fill_with_pebbles(cube, fine);
  ASSERT_EQ(nine.size(), 9u);
  const double r = 0.5 * (std::sqrt(3) - 1) / (std::sqrt(3) + 1);
  for (std::size_t k = 1; k < 9; ++k) {
    EXPECT_NEAR(nine[k].radius / r, 1, 0.02);
    for (double x : nine[k].centre) EXPECT_NEAR(std::min(x, 1 - x), r, 0.01);
  }
}

TEST(clump_fill, cube_gets_corner_pebbles_at_distance_120) {
  EXPECT_EQ(count(cube, 60, 0.5), 1u);
  EXPECT_EQ(count(cube, 117, 0.5), 1u);
  EXPECT_GT(count(cube, 123, 0.5), 1u);
}

TEST(clump_fill, turned_cube_far_away_is_the_same) {
  Rng rng(5, "turn");
  const TriangleMesh turned = testing::turned(cube, rng.rotation(), {100, 200, 300});
  EXPECT_EQ(count(turned, 0, 0.3), 1u);
  EXPECT_EQ(count(turned, 0, 0.2), 9u);
}

TEST(clump_fill, long_box_has_pebbles_on_its_axis_at_the_spacing_of_distance) {
  const TriangleMesh box = testing::box_mesh({1, 1, 5});
  for (double distance : {60., 120., 150.}) {
    const auto pebbles = fill_with_pebbles(box, filling(distance, 0.99));
    const double spacing = std::cos(distance / 2 * degree);  // 2 r cos(distance / 2), r = 0.5
    std::vector<double> places;
    for (const Pebble& p : pebbles) {
      EXPECT_LT(std::hypot(p.centre.x() - 0.5, p.centre.y() - 0.5), 0.02);
      places.push_back(p.centre.z());
    }
    std::sort(places.begin(), places.end());
    for (std::size_t k = 1; k < places.size(); ++k) {
      EXPECT_GE(places[k] - places[k - 1], 0.97 * spacing);
      EXPECT_LE(places[k] - places[k - 1], 2.03 * spacing);  // or another one would have found room
    }
    EXPECT_GE(static_cast<double>(pebbles.size()), 4 / (2 * spacing));
  }
}

TEST(clump_fill, count_grows_with_distance_and_falls_with_ratio) {
  const TriangleMesh box = testing::box_mesh({1, 1.3, 2});
  double last = 0;
  for (double distance : {0., 60., 100., 120., 140., 150., 160.}) {
    const auto n = static_cast<double>(count(box, distance, 0.3));
    EXPECT_GE(n, 0.97 * last) << distance;
    last = n;
  }
  EXPECT_GT(last, 50);
  last = 1e9;
  for (double ratio : {0.25, 0.3, 0.5, 0.8, 1.}) {
    const auto n = static_cast<double>(count(box, 140, ratio));
    EXPECT_LE(n, 1.03 * last) << ratio;
    last = n;
  }
  EXPECT_LE(last, 6);  // its largest balls fill a sheet of 0.3 x 1
}

TEST(clump_fill, keeps_its_promises) {
  expect_kept_promises(cube, filling(150, 0.2));
  expect_kept_promises(testing::box_mesh({1, 2, 0.3}), filling(100, 0.5));
  expect_kept_promises(testing::icosphere(1, 1), filling(160, 0.2));
}

TEST(clump_fill, stops_at_max_pebbles_with_the_largest) {
  ClumpFilling f = filling(150, 0.2);
  const auto all = fill_with_pebbles(cube, f);
  f.max_pebbles = 12;
  const auto some = fill_with_pebbles(cube, f);
  ASSERT_EQ(some.size(), 12u);
  for (std::size_t k = 0; k < 12; ++k) EXPECT_EQ(some[k].centre, all[k].centre);
}

TEST(clump_fill, refuses_parameters_out_of_range) {
  EXPECT_THROW(count(cube, 190, 0.3), InputError);
  EXPECT_THROW(count(cube, -1, 0.3), InputError);
  EXPECT_THROW(count(cube, 100, 0), InputError);
  EXPECT_THROW(count(cube, 100, 1.1), InputError);
}

}  // namespace
}  // namespace trackbed
