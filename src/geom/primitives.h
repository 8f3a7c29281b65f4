// Simple closed meshes.
#pragma once

#include "geom/mesh.h"

namespace trackbed {

/// An axis-aligned box of 12 facets with its lowest corner at `low` [m].
TriangleMesh box_mesh(const Vec3& size, const Vec3& low = Vec3::Zero());

/// An icosahedron whose facets are cut in four `level` times, all vertices on the sphere: 20 x 4^level
/// facets.
TriangleMesh icosphere(int level, double radius);

}  // namespace trackbed
