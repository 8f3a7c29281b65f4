#include "fem/modal_matrix.h"

#include <cmath>

namespace trackbed::fem {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

ModalMatrix operator+(const ModalMatrix& a, const ModalMatrix& b) {
  return {a.diagonal + b.diagonal, a.share + b.share, a.columns ? a.columns : b.columns};
}

ModalMatrix operator*(double factor, const ModalMatrix& a) {
  return {factor * a.diagonal, factor * a.share, a.columns};
}

MatrixXd operator*(const ModalMatrix& a, const MatrixXd& x) {
  MatrixXd product = a.diagonal.asDiagonal() * x;
  if (a.share != 0 && a.columns) product += a.share * (*a.columns * (a.columns->transpose() * x));
  return product;
}

ModalFactor::ModalFactor(const ModalMatrix& matrix) : inverse_(matrix.diagonal.cwiseInverse()) {
  if (!(matrix.diagonal.minCoeff() > 0)) info_ = Eigen::NumericalIssue;
  if (matrix.share == 0 || !matrix.columns || matrix.columns->cols() == 0) return;
  const MatrixXd& q = *matrix.columns;
  scaled_ = inverse_.asDiagonal() * q;
  MatrixXd inner = q.transpose() * scaled_;
  inner.diagonal().array() += 1 / matrix.share;
  small_.compute(inner);
  if (small_.info() != Eigen::Success) info_ = small_.info();
}

MatrixXd ModalFactor::solve(const MatrixXd& right) const {
  MatrixXd x = inverse_.asDiagonal() * right;
  if (scaled_.size() > 0) x -= scaled_ * small_.solve(scaled_.transpose() * right);
  return x;
}

MatrixXd few_columns(MatrixXd matrix, double tolerance) {
  const Index n = matrix.rows();
  VectorXd left = matrix.diagonal();
  const double enough = tolerance * left.cwiseMax(0).sum();
  MatrixXd q(n, 0);
  while (q.cols() < n) {
    Index pivot = 0;
    const double largest = left.maxCoeff(&pivot);
    if (!(left.cwiseMax(0).sum() > enough) || !(largest > 0)) break;
    VectorXd column = matrix.col(pivot) - q * q.row(pivot).transpose();
    column /= std::sqrt(largest);
    q.conservativeResize(Eigen::NoChange, q.cols() + 1);
    q.rightCols(1) = column;
    left -= column.cwiseAbs2();
    left(pivot) = 0;
  }
  return q;
}

}  // namespace trackbed::fem
