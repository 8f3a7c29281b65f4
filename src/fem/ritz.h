// Ritz's method: a structure moves in a few given shapes only.
#pragma once

#include <Eigen/Core>

namespace trackbed::fem {

/// The modes of a structure within given shapes, orthonormal in mass.
struct RitzModes {
  Eigen::VectorXd stiffness;  // squares of their frequencies, ascending [1/s^2]
  Eigen::MatrixXd of_shapes;  // each as a sum of the shapes, a column a mode
};

/// From V^T M V and V^T K V of shapes V. Shapes that others make up but for 1e-10 of the greatest mass are
/// left out.
RitzModes ritz_modes(Eigen::MatrixXd mass, const Eigen::MatrixXd& stiffness);

}  // namespace trackbed::fem
