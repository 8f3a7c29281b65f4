#include "fem/modal_matrix.h"

#include <gtest/gtest.h>

namespace trackbed::fem {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;

MatrixXd full(const ModalMatrix& m) {
  return m * MatrixXd::Identity(m.rows(), m.rows());
}

TEST(ModalMatrix, AddsMultipliesAndSolvesAsTheFullOne) {
  std::srand(1);
  const auto columns = std::make_shared<const MatrixXd>(MatrixXd::Random(9, 3));
  const ModalMatrix a{VectorXd::LinSpaced(9, 1, 5), 2, columns}, b{VectorXd::Ones(9), 0, nullptr};
  const MatrixXd expected = 3 * (MatrixXd(a.diagonal.asDiagonal()) + 2 * *columns * columns->transpose()) +
                            MatrixXd::Identity(9, 9);
  EXPECT_TRUE(full(3 * a + b).isApprox(expected, 1e-14));
  const MatrixXd right = MatrixXd::Random(9, 2);
  EXPECT_TRUE((expected * ModalFactor(3 * a + b).solve(right)).isApprox(right, 1e-12));
}

TEST(ModalMatrix, FewColumnsMakeTheMatrix) {
  std::srand(2);
  const MatrixXd q = MatrixXd::Random(20, 4), matrix = q * q.transpose();
  const MatrixXd found = few_columns(matrix, 1e-12);
  EXPECT_EQ(found.cols(), 4);
  EXPECT_TRUE((found * found.transpose()).isApprox(matrix, 1e-10));
}

}  // namespace
}  // namespace trackbed::fem
