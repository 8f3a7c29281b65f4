// Points spread evenly over a mesh.
#pragma once

#include <vector>

#include "geom/mesh.h"

namespace trackbed {

struct SurfaceSample {
  Vec3 point;
  Vec3 normal;  // outward
};

/// `count` points, each standing for the same area, with their facets' normals: the k-th lies in the k-th of
/// `count` equal shares of the area, placed in its facet by a low-discrepancy sequence (Roberts' R2). No
/// chance.
std::vector<SurfaceSample> sample_surface(const TriangleMesh& mesh, int count);

}  // namespace trackbed
