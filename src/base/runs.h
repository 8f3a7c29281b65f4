// Work on many things by all threads, in runs of consecutive ones.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <functional>

namespace trackbed {

/// n things in runs, each of which one thread takes at a time: as many runs for any number of threads.
class Runs {
 public:
  static constexpr std::size_t most = 64;          // their results fit on the stack
  static constexpr std::size_t least_length = 64;  // things; fewer are not worth a second thread

  explicit Runs(std::size_t n, std::size_t least = least_length)
      : n_(n), length_(std::max(least, (n + most - 1) / most)) {}

  std::size_t count() const { return (n_ + length_ - 1) / length_; }

  /// Does `work(k)` for each k of a run.
  template <class Work>
  void in_run(std::size_t run, const Work& work) const {
    for (std::size_t k = run * length_; k < std::min(n_, (run + 1) * length_); ++k) work(k);
  }

 private:
  std::size_t n_, length_;
};

/// Does `work(r)` for each r below `runs`, by all threads when there is more than one.
void for_each_run(std::size_t runs, const std::function<void(std::size_t)>& work);

/// Does `work(k)` for each k below n.
template <class Work>
void for_each_by_runs(std::size_t n, const Work& work) {
  const Runs runs(n);
  const auto do_run = [&](std::size_t r) { runs.in_run(r, work); };
  for_each_run(runs.count(), std::ref(do_run));  // by reference: nothing is allocated
}

/// What `add(all, k)` makes of an empty All for each k below n. Runs have a result each, and these are joined
/// in their order by `join(first, second)`: the same bits for any number of threads.
template <class All, class Add, class Join>
All joined_by_runs(std::size_t n, const Add& add, const Join& join, std::size_t least = Runs::least_length) {
  const Runs runs(n, least);
  std::array<All, Runs::most> results{};
  const auto do_run = [&](std::size_t r) { runs.in_run(r, [&](std::size_t k) { add(results[r], k); }); };
  for_each_run(runs.count(), std::ref(do_run));
  All all{};
  for (std::size_t r = 0; r < runs.count(); ++r) all = join(all, results[r]);
  return all;
}

/// The sum of what `add(sum, k)` adds for each k below n.
template <class Sum, class Add>
Sum sum_by_runs(std::size_t n, const Add& add, std::size_t least = Runs::least_length) {
  return joined_by_runs<Sum>(
      n, add, [](Sum sum, const Sum& of_run) { return sum += of_run; }, least);
}

}  // namespace trackbed
