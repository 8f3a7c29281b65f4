// Sums over many things by all threads.
#pragma once

#include <algorithm>
#include <cstddef>
#include <functional>
#include <vector>

namespace trackbed {

/// Does `work(k)` for each k below n, every thread its part of them.
void for_each_run(std::size_t n, const std::function<void(std::size_t)>& work);

/// The sum of what `add(sum, k)` adds for each k below n. Runs of things have a sum each, and these are
/// joined in their order by +=: the same bits for any number of threads.
template <class Sum, class Add>
Sum sum_by_runs(std::size_t n, const Add& add) {
  constexpr std::size_t run = 256;
  std::vector<Sum> sums((n + run - 1) / run);
  for_each_run(sums.size(), [&](std::size_t r) {
    Sum sum{};
    for (std::size_t k = r * run; k < std::min(n, (r + 1) * run); ++k) add(sum, k);
    sums[r] = sum;
  });
  Sum all{};
  for (const Sum& sum : sums) all += sum;
  return all;
}

}  // namespace trackbed
