// Which thread works on which patch: the same one in every part of a step, so that what a thread has written
// is near it. Between two groups of cores a line of memory takes six times as long as within one.
#pragma once

#include <omp.h>

namespace trackbed {

/// So many patches are worth more than one thread.
inline bool is_worth_sharing(int patches) {
  return patches > 4;
}

/// A range of patches.
struct Share {
  int first, last;
};

/// Of so many patches those of one of the threads that share them.
inline Share share_of(int thread, int threads, int patches) {
  const auto begin = [&](int t) { return static_cast<int>(static_cast<long long>(patches) * t / threads); };
  return {begin(thread), begin(thread + 1)};
}

/// The patches of this thread, within a parallel region.
inline Share own_share(int patches) {
  return share_of(omp_get_thread_num(), omp_get_num_threads(), patches);
}

}  // namespace trackbed
