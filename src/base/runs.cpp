#include "base/runs.h"

#include <omp.h>

namespace trackbed {

void for_each_run(std::size_t runs, const std::function<void(std::size_t)>& work) {
  // One thread enters no parallel region: leaving one wakes the others by a call of the system.
  if (runs < 2 || omp_get_max_threads() == 1) {
    for (std::size_t r = 0; r < runs; ++r) work(r);
    return;
  }
#pragma omp parallel for schedule(static)
  for (std::size_t r = 0; r < runs; ++r) work(r);
}

}  // namespace trackbed
