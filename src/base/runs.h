// Work on many things by all threads, in runs of consecutive ones.
#pragma once

#include <algorithm>
#include <cstddef>
#include <functional>
#include <vector>

namespace trackbed {

/// Things in a run, which one thread takes at a time: no more than these are not worth a second thread.
constexpr std::size_t run_length = 64;

/// Does `work(r)` for each r below `runs`, by all threads when there is more than one.
void for_each_run(std::size_t runs, const std::function<void(std::size_t)>& work);

/// Does `work(k)` for each k below n.
template <class Work>
void for_each_by_runs(std::size_t n, const Work& work, std::size_t length = run_length) {
  const auto do_run = [&](std::size_t r) {
    for (std::size_t k = r * length; k < std::min(n, (r + 1) * length); ++k) work(k);
  };
  if (n <= length) return do_run(0);
  for_each_run((n + length - 1) / length, do_run);
}

/// What `add(all, k)` makes of an empty All for each k below n. Runs have a result each, and these are joined
/// in their order by `join(first, second)`: the same bits for any number of threads.
template <class All, class Add, class Join>
All joined_by_runs(std::size_t n, const Add& add, const Join& join, std::size_t length = run_length) {
  const auto of_run = [&](std::size_t r) {
    All all{};
    for (std::size_t k = r * length; k < std::min(n, (r + 1) * length); ++k) add(all, k);
    return all;
  };
  if (n <= length) return of_run(0);
  std::vector<All> results((n + length - 1) / length);
  for_each_run(results.size(), [&](std::size_t r) { results[r] = of_run(r); });
  All all{};
  for (const All& result : results) all = join(all, result);
  return all;
}

/// The sum of what `add(sum, k)` adds for each k below n.
template <class Sum, class Add>
Sum sum_by_runs(std::size_t n, const Add& add, std::size_t length = run_length) {
  return joined_by_runs<Sum>(
      n, add, [](Sum sum, const Sum& of_run) { return sum += of_run; }, length);
}

}  // namespace trackbed
