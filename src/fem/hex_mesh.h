// Meshes of hexahedra: blocks and extruded sections.
#pragma once

#include <array>
#include <vector>

#include "base/vec.h"
#include "fem/hexahedron.h"

namespace trackbed::fem {

struct HexMesh {
  std::vector<Vec3> nodes;                // [m]
  std::vector<std::array<int, 8>> cells;  // nodes in the order of HexNodes
  std::vector<int> materials;             // of each cell: which of the elastic solids it is made of

  HexNodes cell_nodes(int cell) const;
};

/// A cross-section made of equal rectangles ("voxels"), to be drawn out along x. y runs across, z up.
struct Section {
  int across = 0, up = 0;         // rectangles along y and z
  double y0 = 0, z0 = 0;          // lower corner [m]
  double dy = 0.075, dz = 0.075;  // sides of a rectangle [m]
  std::vector<int> materials;     // across * up, y first; -1 where there is nothing

  int material(int j, int k) const {
    return j < 0 || k < 0 || j >= across || k >= up ? -1
                                                    : materials[static_cast<std::size_t>(k * across + j)];
  }
};

/// Nodes of a section that belong to a rectangle, numbered y first.
struct SectionNodes {
  std::vector<int> number;               // (across + 1) * (up + 1) grid points, y first: its number, or -1
  std::vector<std::array<int, 2>> grid;  // of each node: grid point along y and z
};
SectionNodes section_nodes(const Section&);

/// Draws a section out along x in `planes - 1` steps of dx [m] from x0. Node p * m + s is node s of the
/// section's m in plane p; cell p * c + e is the e-th rectangle in use between planes p and p + 1.
HexMesh extrude(const Section&, double x0, double dx, int planes);

/// A block of nx * ny * nz equal cells of one material between two corners; nodes z-plane within x-plane as
/// `extrude`.
HexMesh make_block(const Vec3& low, const Vec3& high, int nx, int ny, int nz);

}  // namespace trackbed::fem
