// Small parts for tests of train and track.
#pragma once

#include <memory>

#include "fem/coupled_system.h"
#include "fem/implicit_part.h"

namespace trackbed::fem {

/// A mass on a spring and a dashpot to the ground, pushed by a constant force; one port.
inline std::unique_ptr<DensePart> make_mass(double mass, double stiffness, double damping, double force) {
  Structure<MatrixXd> s{MatrixXd::Constant(1, 1, mass), MatrixXd::Constant(1, 1, damping),
                        MatrixXd::Constant(1, 1, stiffness), VectorXd::Constant(1, force),
                        MatrixXd::Ones(1, 1)};
  return std::make_unique<DensePart>(std::move(s));
}

}  // namespace trackbed::fem
