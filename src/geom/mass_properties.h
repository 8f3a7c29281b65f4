// Volume, centre, inertia and area of a closed mesh, exact for its flat facets.
#pragma once

#include "base/vec.h"
#include "geom/mesh.h"

namespace trackbed {

/// For density 1. The frame's columns are the principal axes in the mesh's frame, right-handed, in the order
/// of ascending moments; the largest component of the first two is positive, so that the frame is unique.
struct MassProperties {
  double volume = 0;              // [m^3]; negative for a mesh turned inside out
  double area = 0;                // [m^2]
  Vec3 centre = Vec3::Zero();     // [m]
  Mat3 inertia = Mat3::Zero();    // about the centre, in the mesh's frame [m^5]
  Vec3 principal = Vec3::Zero();  // principal moments, ascending [m^5]
  Mat3 frame = Mat3::Identity();
};

/// Sums signed tetrahedra over the facets (Tonon 2005).
MassProperties mass_properties(const TriangleMesh& mesh);

/// The mesh seen from its centre of mass along its principal axes.
TriangleMesh in_principal_frame(const TriangleMesh& mesh, const MassProperties& mass);

}  // namespace trackbed
