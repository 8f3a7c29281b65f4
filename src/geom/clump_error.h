// How well a clump stands for its stone.
#pragma once

#include <vector>

#include "geom/clump_template.h"
#include "geom/mesh.h"

namespace trackbed {

struct ClumpError {
  double volume_ratio = 0;   // union of the pebbles / mesh
  double mean_distance = 0;  // from points spread over the mesh to the surface of the clump [m]
  double max_distance = 0;   // [m]
};

/// Compares pebbles with the solid they fill, both in the same frame. The volume is good to 0.1 %. Where a
/// pebble sticks out of the mesh, the distance is that to the nearest point of this pebble's sphere.
ClumpError clump_error(const TriangleMesh& solid, const std::vector<Pebble>& pebbles);

/// Volume of the union of spheres [m^3], overlap counted once: lines x lines parallel lines through their
/// box, each integrated exactly.
double union_volume(const std::vector<Pebble>& pebbles, int lines);

}  // namespace trackbed
