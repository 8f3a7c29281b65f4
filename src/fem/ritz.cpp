#include "fem/ritz.h"

#include <utility>

#include "fem/blas.h"

namespace trackbed::fem {

RitzModes ritz_modes(Eigen::MatrixXd mass, const Eigen::MatrixXd& stiffness) {
  constexpr double same = 1e-10;
  const Eigen::VectorXd values = diagonalise(mass);
  const Eigen::Index n = values.size();
  Eigen::Index drop = 0;
  while (values[drop] < same * values[n - 1]) ++drop;
  const Eigen::MatrixXd basis =
      mass.rightCols(n - drop) * values.tail(n - drop).cwiseSqrt().cwiseInverse().asDiagonal();
  RitzModes modes;
  modes.of_shapes = basis.transpose() * (stiffness * basis).eval();
  modes.stiffness = diagonalise(modes.of_shapes);
  modes.of_shapes = (basis * modes.of_shapes).eval();
  return modes;
}

}  // namespace trackbed::fem
