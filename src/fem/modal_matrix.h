// A diagonal matrix, and one to which few columns are added: what modes are damped by, and their factor.
#pragma once

#include <Eigen/Cholesky>
#include <Eigen/Core>
#include <memory>

namespace trackbed::fem {

/// diag(diagonal) + share Q Q^T with Q of few columns, n x r. Matrices of one sum share their Q.
struct ModalMatrix {
  Eigen::VectorXd diagonal;
  double share = 0;
  std::shared_ptr<const Eigen::MatrixXd> columns;  // Q; nothing: share is 0

  Eigen::Index rows() const { return diagonal.size(); }
};

ModalMatrix operator+(const ModalMatrix& a, const ModalMatrix& b);
ModalMatrix operator*(double factor, const ModalMatrix& a);
Eigen::MatrixXd operator*(const ModalMatrix& a, const Eigen::MatrixXd& x);

/// Solves with a ModalMatrix that is positive (Sherman, Morrison & Woodbury).
class ModalFactor {
 public:
  explicit ModalFactor(const ModalMatrix& matrix);
  Eigen::MatrixXd solve(const Eigen::MatrixXd& right) const;
  Eigen::ComputationInfo info() const { return info_; }

 private:
  Eigen::VectorXd inverse_;  // of the diagonal
  Eigen::MatrixXd scaled_;   // Q / diagonal, n x r
  Eigen::LLT<Eigen::MatrixXd> small_;
  Eigen::ComputationInfo info_ = Eigen::Success;
};

/// Few columns Q with Q Q^T = matrix, which has no negative eigenvalues, by Cholesky with pivots: until the
/// diagonal left is below `tolerance` of its sum.
Eigen::MatrixXd few_columns(Eigen::MatrixXd matrix, double tolerance);

}  // namespace trackbed::fem
