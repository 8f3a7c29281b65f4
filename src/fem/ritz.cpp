#include "fem/ritz.h"

#include <cmath>
#include <utility>

#include "fem/blas.h"

namespace trackbed::fem {

MassBasis::MassBasis(Mass mass, Eigen::Index rows, Eigen::Index most)
    : mass_(std::move(mass)), all_(rows, most) {}

bool MassBasis::add(Eigen::VectorXd column) {
  constexpr double same = 1e-6;
  auto norm = [&] { return std::sqrt(column.dot(mass_(column))); };
  const double before = norm();
  if (before == 0) return false;
  column /= before;
  for (int again = 0; again < 2; ++again) {
    const Eigen::VectorXd parts = columns().transpose() * mass_(column);
    column.noalias() -= columns() * parts;
  }
  const double left = norm();
  if (left < same) return false;
  all_.col(count_++) = column / left;
  return true;
}

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
