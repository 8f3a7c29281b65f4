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

/// An upright cylinder of the given diameter and height [m] as a prism of `sides` sides; the middle of its
/// base is the origin. Its corners lie on the circle.
TriangleMesh cylinder_mesh(double diameter, double height, int sides = 64);

/// Adds the rectangle from `corner` along two edges, as two facets that face along a x b; its corners are
/// vertices of its own.
void add_rectangle(TriangleMesh& mesh, const Vec3& corner, const Vec3& a, const Vec3& b);

/// An icosahedron whose facets are cut in four `level` times, all vertices on the sphere: 20 x 4^level
/// facets.
TriangleMesh icosphere(int level, double radius);

}  // namespace trackbed
