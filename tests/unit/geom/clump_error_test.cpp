#include "geom/clump_error.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "shapes.h"

namespace trackbed {
namespace {

double ball(double r) {
  return 4.0 / 3 * std::numbers::pi * r * r * r;
}

TEST(clump_error, union_of_two_spheres_less_their_lens) {
  const double r = 1, s = 0.7, d = 1.2;
  const double lens = std::numbers::pi * std::pow(r + s - d, 2) *
                      (d * d + 2 * d * (r + s) - 3 * (r - s) * (r - s)) / (12 * d);
  const std::vector<Pebble> two = {{{5, 0, 0}, r}, {{5 + d / std::sqrt(2), d / std::sqrt(2), 0}, s}};
  const double exact = ball(r) + ball(s) - lens;
  EXPECT_NEAR(union_volume(two, 400) / exact, 1, 2e-4);
  EXPECT_NEAR(union_volume(two, 160) / exact, 1, 5e-4);
}

TEST(clump_error, sphere_in_its_cube) {
  // From a face point at distance q from the face's centre to the sphere: sqrt(1/4 + q^2) - 1/2.
  const ClumpError error = clump_error(testing::box_mesh(Vec3::Ones()), {{Vec3::Constant(0.5), 0.5}});
  EXPECT_NEAR(error.volume_ratio, std::numbers::pi / 6, 2e-4);
  EXPECT_NEAR(error.max_distance, (std::sqrt(3) - 1) / 2, 0.01);
  double mean = 0;
  const int n = 500;
  for (int i = 0; i < n; ++i)
    for (int j = 0; j < n; ++j)
      mean += (std::hypot(0.5, (i + 0.5) / n - 0.5, (j + 0.5) / n - 0.5) - 0.5) / (n * n);
  EXPECT_NEAR(error.mean_distance, mean, 1e-3);
}

TEST(clump_error, pebble_that_sticks_out_counts_too) {
  const ClumpError error = clump_error(testing::icosphere(4, 1), {{Vec3::Zero(), 1.05}});
  EXPECT_NEAR(error.mean_distance, 0.05, 2e-3);
  EXPECT_NEAR(error.volume_ratio, std::pow(1.05, 3), 5e-3);
}

}  // namespace
}  // namespace trackbed
