#include "fem/blas.h"

#include <cblas.h>

#include <string_view>
#include <vector>

#include "base/error.h"

extern "C" void dsyevd_(const char* vectors, const char* triangle, const int* n, double* a, const int* lda,
                        double* w, double* work, const int* lwork, int* iwork, const int* liwork, int* info);

namespace trackbed::fem {

void use_one_blas_thread() {
  openblas_set_num_threads(1);
}

std::string blas_kernels_to_ask_for() {
#if defined(__x86_64__)
  if (std::string_view(openblas_get_corename()) != "Prescott") return "";
  if (__builtin_cpu_supports("avx512vl") && __builtin_cpu_supports("avx512dq")) return "SkylakeX";
  if (__builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma")) return "Haswell";
#endif
  return "";
}

Eigen::VectorXd diagonalise(Eigen::MatrixXd& matrix) {
  use_one_blas_thread();
  const int n = static_cast<int>(matrix.rows());
  Eigen::VectorXd values(n);
  std::vector<double> work(1);
  std::vector<int> integers(1);
  int info = 0;
  auto call = [&](int size, int integer_size) {
    dsyevd_("V", "L", &n, matrix.data(), &n, values.data(), work.data(), &size, integers.data(),
            &integer_size, &info);
    if (info != 0) throw RunError("the eigenvalues of a reduced model do not converge");
  };
  call(-1, -1);  // asks for the sizes
  work.resize(static_cast<std::size_t>(work[0]));
  integers.resize(static_cast<std::size_t>(integers[0]));
  call(static_cast<int>(work.size()), static_cast<int>(integers.size()));
  return values;
}

}  // namespace trackbed::fem
