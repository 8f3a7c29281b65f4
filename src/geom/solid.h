// From a mesh as scanned to a closed solid, or a true reason why not.
#pragma once

#include <string>
#include <vector>

#include "geom/mesh.h"

namespace trackbed {

/// A mesh that bounds one body: closed, manifold, facets outward, no two facets cross, none without area.
/// Handles (a hole through the stone) are allowed.
struct Solid {
  TriangleMesh mesh;
  std::vector<std::string> repairs;  // what had to be changed, in words; empty when the mesh is as it came
};

/// Checks a mesh and repairs what is safe: doubled vertices and facets, facets without area, facets turned
/// inward, non-manifold vertices and edges, holes below 1 % of the surface, shells below 2 % of the volume,
/// crossing facets where the cure changes the volume by less than 0.1 %.
/// Throws InputError beginning with `name` when more would be needed.
Solid make_solid(const TriangleMesh& mesh, const std::string& name);

}  // namespace trackbed
