// Sparse Cholesky factors by CHOLMOD: supernodal, ordered by METIS.
#pragma once

#include <Eigen/Core>
#include <memory>

#include "fem/assembly.h"

namespace trackbed::fem {

/// L L^T of a symmetric positive definite matrix. The graph of nodes is ordered and the order carried over to
/// the displacements of each node, which is quicker than to order those, with no more fill. BLAS works with
/// one thread, so that results are the same bits on every number of threads; right-hand sides are shared
/// among threads.
class SparseCholesky {
 public:
  /// Both triangles of the matrix are taken to be stored. `freedoms` tells which rows belong to a node.
  /// Throws RunError when the matrix is not positive definite (something is not held) or memory does not
  /// suffice.
  SparseCholesky(const SparseMatrix&, const Freedoms& freedoms);
  ~SparseCholesky();
  SparseCholesky(SparseCholesky&&) noexcept;

  /// Takes another matrix of the same pattern: the order of the nodes stays. Throws as above.
  void refactor(const SparseMatrix&);

  /// Solutions, a column for each right-hand side. Two factors may be in use at once.
  Eigen::MatrixXd solve(const Eigen::MatrixXd& right_hand_sides) const;

  double factor_bytes() const;

 private:
  struct Parts;
  std::unique_ptr<Parts> parts_;
};

}  // namespace trackbed::fem
