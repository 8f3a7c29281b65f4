#include "dem/threads.h"

#include <omp.h>

namespace trackbed {

int use_threads(int threads) {
  if (threads > 0)
    omp_set_num_threads(threads);
  else
    omp_set_num_threads(omp_get_num_procs());
  return omp_get_max_threads();
}

}  // namespace trackbed
