// Ritz's method: a structure moves in a few given shapes only.
#pragma once

#include <Eigen/Core>
#include <functional>

namespace trackbed::fem {

/// Columns orthonormal in mass, each new one to all before it (Gram and Schmidt, twice).
class MassBasis {
 public:
  using Mass = std::function<Eigen::VectorXd(const Eigen::VectorXd&)>;  // M v

  /// For `most` columns of `rows` at most.
  MassBasis(Mass mass, Eigen::Index rows, Eigen::Index most);

  /// Tells whether it was taken: zeros are not, nor what those before make up but for 1e-6 of its norm.
  bool add(Eigen::VectorXd column);
  auto columns() const { return all_.leftCols(count_); }

 private:
  Mass mass_;
  Eigen::MatrixXd all_;
  Eigen::Index count_ = 0;
};

/// The modes of a structure within given shapes, orthonormal in mass.
struct RitzModes {
  Eigen::VectorXd stiffness;  // squares of their frequencies, ascending [1/s^2]
  Eigen::MatrixXd of_shapes;  // each as a sum of the shapes, a column a mode
};

/// From V^T M V and V^T K V of shapes V. Shapes that others make up but for 1e-10 of the greatest mass are
/// left out.
RitzModes ritz_modes(Eigen::MatrixXd mass, const Eigen::MatrixXd& stiffness);

}  // namespace trackbed::fem
