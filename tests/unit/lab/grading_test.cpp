#include "lab/grading.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <numeric>

#include "base/units.h"

namespace trackbed {
namespace {

double volume_of(const std::vector<double>& sizes) {
  double volume = 0;
  for (double d : sizes) volume += std::numbers::pi / 6 * d * d * d;
  return volume;
}

/// Solid volume that about n stones of the grading fill [m^3].
double volume_for(const GradingInput& grading, double n) {
  Rng rng(9, "trial");
  const double trial = 0.1;
  return trial * n / static_cast<double>(draw_sizes(grading, Space{}, trial, rng).size());
}

TEST(Grading, TwoThousandStonesPassAsAskedWithinOnePercent) {
  const GradingInput coarse;
  const GradingInput gap{{0.01, 0.02, 0.03, 0.05}, {0, 0.4, 0.4, 1}, "volume"};
  for (const GradingInput& grading : {coarse, gap})
    for (std::uint64_t seed : {1, 2, 3}) {
      Rng rng(seed, "grading");
      const double volume = volume_for(grading, 2000);
      const std::vector<double> sizes = draw_sizes(grading, Space{}, volume, rng);
      EXPECT_NEAR(static_cast<double>(sizes.size()), 2000, 200);
      EXPECT_NEAR(volume_of(sizes) / volume, 1, 0.01);
      EXPECT_TRUE(std::is_sorted(sizes.rbegin(), sizes.rend()));
      EXPECT_GE(sizes.back(), smallest_size(grading));
      const std::vector<double> shares = passing(grading, Space{}, sizes);
      for (std::size_t k = 0; k < shares.size(); ++k) EXPECT_NEAR(shares[k], grading.passing[k], 0.01) << k;
    }
}

TEST(Grading, SmallestSizeIsWhereTheCurveLeavesZero) {
  EXPECT_EQ(smallest_size({{0.01, 0.02, 0.03}, {0, 0, 1}, "volume"}), 0.02);
  EXPECT_EQ(smallest_size({}), 0.0224);
}

// What a user writes in mm is what another writes in m: the sizes agree to rounding, stone for stone.
TEST(Grading, TheSameInMillimetresAndMetres) {
  const auto with_sieves = [](const std::vector<std::string>& texts) {
    GradingInput grading;
    grading.sieves.clear();
    for (const std::string& text : texts)
      grading.sieves.push_back(std::get<double>(parse_quantity(text, Dimension::length)));
    Rng rng(4, "grading");
    return draw_sizes(grading, Space{}, 0.05, rng);
  };
  const auto mm = with_sieves({"22.4 mm", "31.5 mm", "40 mm", "50 mm", "63 mm"});
  const auto m = with_sieves({"0.0224 m", "0.0315 m", "0.04 m", "0.05 m", "0.063 m"});
  ASSERT_EQ(mm.size(), m.size());
  for (std::size_t k = 0; k < m.size(); ++k) EXPECT_NEAR(mm[k] / m[k], 1, 1e-14);
}

TEST(Grading, ScaleGivesTheSizeAsItIsMeasured) {
  ClumpTemplate stone = make_ball_template(0.01);
  stone.sieve_size = 0.016;
  GradingInput grading;
  EXPECT_NEAR(scale_to_size(grading, Space{}, stone, 0.04), 2, 1e-14);
  grading.size = "sieve";
  EXPECT_NEAR(scale_to_size(grading, Space{}, stone, 0.04), 2.5, 1e-14);
}

TEST(Grading, ScaledSievesGiveTheSameStonesScaled) {
  GradingInput grading;
  const Space space;
  const double volume = 0.01;
  Rng rng(4, "sizes"), again(4, "sizes");
  const std::vector<double> sizes = draw_sizes(grading, space, volume, rng);
  grading.scale = 3;
  const std::vector<double> scaled = draw_sizes(grading, space, 27 * volume, again);
  ASSERT_EQ(scaled.size(), sizes.size());
  for (std::size_t k = 0; k < sizes.size(); ++k) EXPECT_NEAR(scaled[k] / sizes[k], 3, 1e-12);
  EXPECT_EQ(smallest_size(grading), 3 * grading.sieves[0]);
  const std::vector<double> shares = passing(grading, space, scaled);
  for (std::size_t k = 0; k < shares.size(); ++k) EXPECT_NEAR(shares[k], grading.passing[k], 0.01);
}

}  // namespace
}  // namespace trackbed
