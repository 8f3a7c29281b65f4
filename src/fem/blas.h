// What we take from BLAS and LAPACK by ourselves.
#pragma once

#include <Eigen/Core>
#include <string>

namespace trackbed::fem {

/// BLAS shares its work among threads in ways that change the last bits: from now on it uses one. Trackbed's
/// own threads call it side by side.
void use_one_blas_thread();

/// What OPENBLAS_CORETYPE should be before the library is loaded: a processor that is younger than it gets
/// its oldest kernels, a third as fast. Empty where it knows the processor.
std::string blas_kernels_to_ask_for();

/// Eigenvalues of a symmetric matrix, ascending; its eigenvectors take the matrix' place (LAPACK's dsyevd,
/// some ten times as fast as Eigen's for a thousand rows). Throws RunError when it does not converge.
Eigen::VectorXd diagonalise(Eigen::MatrixXd& matrix);

}  // namespace trackbed::fem
