// Simple meshes.
#pragma once

#include "geom/mesh.h"

namespace trackbed {

/// A cuboid of the given edge lengths [m] with its centre at the origin, facing outward.
TriangleMesh box_mesh(const Vec3& size);

}  // namespace trackbed
