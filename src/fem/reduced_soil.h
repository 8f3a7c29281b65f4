// The soil with few unknowns, for implicit time steps. See soil.h for ports and signs.
#pragma once

#include <filesystem>

#include "fem/soil.h"

namespace trackbed::fem {

struct ReductionInput {
  int krylov = 3;  // vectors K^-1 M ... beside the static one, of each pressure shape: 1 % at worst of a
                   // sleeper's peak
  double window =
      18;  // length of soil in which a footing's columns are worked out [m]; beyond it they are zero
};

/// Displacements u = V q of all nodes, V orthonormal in mass and stiffness:
///     q'' + damping q' + diag(stiffness) q = nodes^T f + gravity,     displacement of footing nodes = nodes
///     q
/// n unknowns: about footings x shapes x (1 + krylov).
struct ReducedSoil {
  Eigen::VectorXd stiffness;  // n, ascending: squares of the natural frequencies [1/s2]
  Eigen::MatrixXd damping;    // n x n [1/s]: diagonal but for the dashpots of absorbing faces
  Eigen::MatrixXd nodes;      // footing nodes x n
  Eigen::VectorXd gravity;    // n: force of the soil's own weight, 9.81 m/s2 downwards
};

/// Galerkin projection on static and Krylov columns of every footing's pressure shapes. Columns of footings
/// further than half a window from both ends are worked out once and shifted.
ReducedSoil reduce(const Soil&, const ReductionInput& = {});

/// The same, read from `folder` when it has been worked out there before for this very input, else kept
/// there. The file is named by a hash of the input and written beside and moved into place.
ReducedSoil reduce(const Soil&, const ReductionInput&, const std::filesystem::path& folder);

}  // namespace trackbed::fem
