#include "fem/sparse_cholesky.h"

#include <gtest/gtest.h>

#include "base/error.h"

namespace trackbed::fem {
namespace {

/// A chain of nodes along x, each held to its neighbours and to the ground.
struct Chain {
  Freedoms freedoms{20};
  SparseMatrix matrix;
  explicit Chain(double ground) {
    for (int n = 0; n < 20; ++n)
      for (int axis : {1, 2}) freedoms.hold(n, axis);
    freedoms.number();
    std::vector<Eigen::Triplet<double>> entries;
    for (int n = 0; n < 20; ++n) entries.emplace_back(n, n, 2 + ground);
    for (int n = 1; n < 20; ++n)
      for (auto [i, j] : {std::pair{n, n - 1}, {n - 1, n}}) entries.emplace_back(i, j, -1);
    matrix.resize(20, 20);
    matrix.setFromTriplets(entries.begin(), entries.end());
  }
};

TEST(SparseCholesky, SolvesWhatItHasFactoredLast) {
  const Chain soft(0.1), stiff(3), none(-2);
  const Eigen::MatrixXd right = Eigen::MatrixXd::Random(20, 35);
  SparseCholesky factor(soft.matrix, soft.freedoms);
  EXPECT_LT((soft.matrix * factor.solve(right) - right).cwiseAbs().maxCoeff(), 1e-12);
  factor.refactor(stiff.matrix);
  EXPECT_LT((stiff.matrix * factor.solve(right) - right).cwiseAbs().maxCoeff(), 1e-12);
  EXPECT_EQ(factor.solve(right), SparseCholesky(stiff.matrix, stiff.freedoms).solve(right));
  EXPECT_THROW(factor.refactor(none.matrix), RunError);
}

}  // namespace
}  // namespace trackbed::fem
