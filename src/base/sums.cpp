#include "base/sums.h"

namespace trackbed {

void for_each_run(std::size_t n, const std::function<void(std::size_t)>& work) {
#pragma omp parallel for schedule(static) if (n > 1)
  for (std::size_t k = 0; k < n; ++k) work(k);
}

}  // namespace trackbed
