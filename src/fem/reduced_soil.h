// The soil with few unknowns, for implicit time steps. See soil.h for ports and signs.
#pragma once

#include <filesystem>

#include "fem/soil.h"

namespace trackbed::fem {

struct ReductionInput {
  /// Vectors K^-1 M ... of each pressure shape beside the static one. Errors of peaks with 3: some 0.3 %
  /// under blows of 20 ms, 0.5 % of 10 ms, 5 % of 5 ms; docs/theory.md, section 11.4.
  int krylov = 3;
  /// The same for footings within half a window of a free end. Beside a bridge sleepers hang and strike the
  /// soil with blows of some 2 ms; those beyond `krylov` are worked out about these, (K + s^2 M)^-1 M ...
  int krylov_at_free_end = 8;
  /// Length of the soil in which a footing's columns are worked out [m]; beyond it they are zero. 18 m
  /// changes nothing; 6 m changes 0.02 % under axles and 1 % under blows of 10 ms.
  double window = 12;
  /// s / 2 pi [Hz]; 0: all about rest, which leaves 14 % instead of 2 % of error in how the soil swings after
  /// a blow of 2 ms.
  double blow_frequency = 200;
};

/// Displacements u = V q of all nodes, V orthonormal in mass and stiffness:
///     q'' + damping q' + diag(stiffness) q = nodes^T f + gravity,     footings: u = nodes q
/// n unknowns: the sum of shapes x (1 + krylov) over footings, less those that others span.
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
/// Is it there, whole or not?
bool is_kept(const Soil&, const ReductionInput&, const std::filesystem::path& folder);

}  // namespace trackbed::fem
