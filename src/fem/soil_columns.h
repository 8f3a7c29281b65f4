// The columns of a reduction: what a footing's pressure shapes do to the soil around it.
#pragma once

#include <vector>

#include "fem/reduced_soil.h"

namespace trackbed::fem {

/// Displacements of a run of planes, a few for one footing, more beside a free end: nodes plane by plane,
/// three displacements each. Those of a footing far from both ends serve many footings, shifted.
struct SoilColumns {
  Eigen::MatrixXd values;  // orthonormal in mass
  Eigen::MatrixXd forces;  // K values
  int footing_plane;       // of the footing's first nodes, from the run's first plane
};

struct ColumnSets {
  std::vector<SoilColumns> sets;
  std::vector<int> set_of;       // of each footing
  std::vector<int> first_plane;  // of each footing: where its columns begin
};

/// Lumped masses (or dashpots) of a run of planes, in the order of SoilColumns.
Eigen::VectorXd masses_of(const Soil&, int first_plane, int planes);
Eigen::VectorXd dashpots_of(const Soil&, int first_plane, int planes);

/// Static columns K^-1 B of the pressure shapes B, and Krylov columns K^-1 M V, beside a free end also
/// (K + s^2 M)^-1 M V, of those before, each footing's in a window about it that is held where it is cut out
/// of the soil. Throws InputError when there are fewer than none, or more than the mesh has.
ColumnSets make_columns(const Soil&, const ReductionInput&);

}  // namespace trackbed::fem
