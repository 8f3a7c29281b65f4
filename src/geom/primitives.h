// Simple closed meshes.
#pragma once

#include "geom/mesh.h"

namespace trackbed {

/// An axis-aligned box of 12 facets with its lowest corner at `low` [m].
TriangleMesh box_mesh(const Vec3& size, const Vec3& low = Vec3::Zero());

/// A block of the given length, width and height [m] on wedges that point down, side by side along its length
/// with their ridges across it; their faces rise by `angle` [rad], above 0 and below pi/2. The middle of the
/// block's base is the origin.
TriangleMesh wedge_mesh(const Vec3& size, double angle, int wedges);

/// An icosahedron whose facets are cut in four `level` times, all vertices on the sphere: 20 x 4^level
/// facets.
TriangleMesh icosphere(int level, double radius);

}  // namespace trackbed
