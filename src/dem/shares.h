// Which thread works on which patch: the same one in every part of a step, so that what a thread has written
// is near it. Between two groups of cores a line of memory takes six times as long as within one.
#pragma once

#include <omp.h>

namespace trackbed {

/// A range of patches.
struct Share {
  int first, last;
};

/// Of so many patches those of one of the threads that share them.
inline Share share_of(int thread, int threads, int patches) {
  const auto begin = [&](int t) { return static_cast<int>(static_cast<long long>(patches) * t / threads); };
  return {begin(thread), begin(thread + 1)};
}

/// So many threads share so many patches.
inline int sharing_threads(int patches) {
  constexpr int worth_sharing = 5;
  return patches < worth_sharing ? 1 : omp_get_max_threads();
}

/// Does `work` on every share, by the thread that owns it. One thread enters no parallel region: leaving one
/// wakes the others by a call of the system, even where there are none, and a small bed has a step done in
/// the time of twenty.
template <class Work>
void for_all_shares(int patches, Work&& work) {
  if (sharing_threads(patches) == 1) return work(Share{0, patches});
#pragma omp parallel
  work(share_of(omp_get_thread_num(), omp_get_num_threads(), patches));
}

/// The same with the results of the work joined, in any order.
template <class Work, class Join>
auto joined_of_shares(int patches, Work&& work, Join&& join) {
  if (sharing_threads(patches) == 1) return work(Share{0, patches});
  decltype(work(Share{})) all{};
  for_all_shares(patches, [&](const Share& own) {
    const auto result = work(own);
#pragma omp critical(joined_of_shares)
    all = join(all, result);
  });
  return all;
}

}  // namespace trackbed
