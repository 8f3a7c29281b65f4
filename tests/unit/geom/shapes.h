// Shapes for the tests of this folder.
#pragma once

#include "geom/primitives.h"

namespace trackbed::testing {

using trackbed::box_mesh;
using trackbed::icosphere;

inline TriangleMesh turned(TriangleMesh mesh, const Quat& rotation, const Vec3& shift = Vec3::Zero()) {
  for (Vec3& v : mesh.vertices) v = rotation * v + shift;
  return mesh;
}

}  // namespace trackbed::testing
