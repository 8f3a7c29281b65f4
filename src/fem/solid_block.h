// Sleepers and slabs of hexahedra, seen through their ports: a few shapes stand for all their displacements.
#pragma once

#include <vector>

#include "base/vec.h"
#include "fem/elastic.h"
#include "fem/hexahedron.h"
#include "fem/implicit_part.h"

namespace trackbed::fem {

/// A rectangle of the upper or lower face; its port is the mean vertical displacement there [m].
struct FacePatch {
  double x_low, x_high, y_low, y_high;  // [m]
  bool upper;
};

struct SolidBlock {
  Vec3 low, high;  // x along the track, y across, z up [m]
  double element;  // edges of the hexahedra are no longer than that [m]
  Elastic solid;
  HexKind kind = HexKind::incompatible;
  bool symmetric = true;     // about y = low.y: a half stands for the whole
  bool on_supports = false;  // the lower edges of both ends lie on rollers; else it floats
};

/// The block's motion in the modes of its ports' static shapes and of three Krylov shapes of each; u of the
/// structure are modal coordinates. `load` is the weight; `damping` a share of the stiffness [s].
/// Throws InputError for a block without extent.
Structure<MatrixXd> reduce_block(const SolidBlock&, const std::vector<FacePatch>& ports, double gravity,
                                 double damping);

}  // namespace trackbed::fem
