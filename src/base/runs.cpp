#include "base/runs.h"

namespace trackbed {

void for_each_run(std::size_t runs, const std::function<void(std::size_t)>& work) {
#pragma omp parallel for schedule(static) if (runs > 1)
  for (std::size_t r = 0; r < runs; ++r) work(r);
}

}  // namespace trackbed
