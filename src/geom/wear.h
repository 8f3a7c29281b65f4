// Stones whose edges have been worn off.
#pragma once

#include "geom/mesh.h"

namespace trackbed {

/// A solid whose edges and corners are rounded over about `share` of its mean radius (that of the ball of
/// equal volume), and whose volume and centre of mass are what they were. Its surface moves as if by mean
/// curvature, as stones do that wear each other: one implicit step of the diffusion of its vertices over the
/// time (share x radius)^2 / 2 (Desbrun et al. 1999). The mesh must be finer than that length; share 0
/// changes nothing.
TriangleMesh worn(const TriangleMesh& solid, double share);

}  // namespace trackbed
