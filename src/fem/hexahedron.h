// The matrices of the hexahedron of eight nodes.
#pragma once

#include <string_view>

#include "base/vec.h"
#include "fem/elastic.h"

namespace trackbed::fem {

/// Places of the nodes of an element, a column a node [m]: those of the lower face (local z = -1) against the
/// clock, then those above them.
using HexNodes = Eigen::Matrix<double, 3, 8>;
/// Three displacements of each node together: ux0, uy0, uz0, ux1, ...
using HexMatrix = Eigen::Matrix<double, 24, 24>;
using HexVector = Eigen::Matrix<double, 24, 1>;

/// How strain is taken from displacements.
enum class HexKind {
  full,   ///< 2 x 2 x 2 Gauss points: stiff in bending
  b_bar,  ///< the volume strain is its mean over the element (selective reduced integration; Hughes 1980)
  incompatible  ///< three quadratic modes inside the element (Taylor, Beresford & Wilson 1976): exact in
                ///< bending
};

/// Stiffness [N/m], symmetric, of rank 18. Throws InputError for an element that is turned inside out.
HexMatrix hex_stiffness(const HexNodes&, const Elastic&, HexKind);

/// Consistent mass [kg].
HexMatrix hex_mass(const HexNodes&, double density);

/// Lumped mass of each node [kg]: row sums of the consistent one.
Eigen::Matrix<double, 8, 1> hex_lumped_mass(const HexNodes&, double density);

/// Stress at the centre of an element [Pa], order as in Elastic::stiffness. There the gradients of the
/// incompatible modes are zero, and of bricks the volume strain is its mean, so that all kinds have the same.
Eigen::Matrix<double, 6, 1> hex_stress(const HexNodes&, const Elastic&, const HexVector& displacement);

}  // namespace trackbed::fem
