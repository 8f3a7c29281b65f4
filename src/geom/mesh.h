// Triangle meshes: stones as scanned, walls, sleepers.
#pragma once

#include <array>
#include <vector>

#include "base/vec.h"

namespace trackbed {

/// An indexed triangle mesh. Facets of a closed mesh turn anticlockwise seen from outside.
struct TriangleMesh {
  std::vector<Vec3> vertices;              // [m]
  std::vector<std::array<int, 3>> facets;  // indices into vertices

  std::array<Vec3, 3> corners(std::size_t facet) const {
    const auto& f = facets[facet];
    return {vertices[static_cast<std::size_t>(f[0])], vertices[static_cast<std::size_t>(f[1])],
            vertices[static_cast<std::size_t>(f[2])]};
  }
};

}  // namespace trackbed
