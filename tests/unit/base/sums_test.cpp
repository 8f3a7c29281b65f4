#include "base/sums.h"

#include <gtest/gtest.h>
#include <omp.h>

#include "base/rng.h"

namespace trackbed {
namespace {

TEST(Sums, AreTheSameBitsForAnyNumberOfThreads) {
  Rng rng(1, "sums");
  std::vector<double> numbers(10'000);
  for (double& x : numbers) x = rng.uniform(-1, 1);
  const int before = omp_get_max_threads();
  std::vector<double> sums;
  for (int threads : {1, 2, 3}) {
    omp_set_num_threads(threads);
    sums.push_back(
        sum_by_runs<double>(numbers.size(), [&](double& sum, std::size_t k) { sum += numbers[k]; }));
  }
  omp_set_num_threads(before);
  EXPECT_EQ(sums[1], sums[0]);
  EXPECT_EQ(sums[2], sums[0]);
}

TEST(Sums, CountEveryThingOnce) {
  for (std::size_t n : {0, 1, 255, 256, 257, 1000})
    EXPECT_EQ(sum_by_runs<std::size_t>(n, [](std::size_t& sum, std::size_t k) { sum += k + 1; }),
              n * (n + 1) / 2);
}

}  // namespace
}  // namespace trackbed
