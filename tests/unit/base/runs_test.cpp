#include "base/runs.h"

#include <gtest/gtest.h>
#include <omp.h>

#include "base/rng.h"

namespace trackbed {
namespace {

TEST(Runs, SumToTheSameBitsForAnyNumberOfThreads) {
  Rng rng(1, "runs");
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

TEST(Runs, SumEveryThingOnce) {
  for (std::size_t n : {0, 1, 63, 64, 65, 1000, 4096, 4097})
    EXPECT_EQ(sum_by_runs<std::size_t>(n, [](std::size_t& sum, std::size_t k) { sum += k + 1; }),
              n * (n + 1) / 2);
}

TEST(Runs, DoEveryThingOnce) {
  for (std::size_t n : {0, 1, 64, 65, 1000, 4096, 4097}) {
    std::vector<int> done(n, 0);
    for_each_by_runs(n, [&](std::size_t k) { ++done[k]; });
    EXPECT_EQ(std::ranges::count(done, 1), static_cast<std::ptrdiff_t>(n));
  }
}

TEST(Runs, AreJoinedInTheirOrder) {
  using List = std::vector<std::size_t>;
  const auto joined = [](List a, const List& b) {
    a.insert(a.end(), b.begin(), b.end());
    return a;
  };
  const List all = joined_by_runs<List>(
      1000, [](List& list, std::size_t k) { list.push_back(k); }, joined, 7);
  ASSERT_EQ(all.size(), 1000u);
  EXPECT_TRUE(std::ranges::is_sorted(all));
}

}  // namespace
}  // namespace trackbed
