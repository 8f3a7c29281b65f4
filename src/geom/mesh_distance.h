// How far a point is from the surface of a solid.
#pragma once

#include <vector>

#include "geom/mesh.h"
#include "geom/sphere_tree.h"

namespace trackbed {

/// Answers distance questions about one closed mesh, which is copied. Exact for the flat facets.
class MeshDistance {
 public:
  explicit MeshDistance(const TriangleMesh& mesh);

  /// Distance to the surface [m], positive inside the solid, negative outside. The side follows from the
  /// angle-weighted normal at the nearest point (Baerentzen & Aanaes 2005), which is right at edges and
  /// corners.
  double depth(const Vec3& p) const;

 private:
  struct Nearest {
    double distance2;
    Vec3 point;
    std::size_t facet;
    int feature;  // 0-2: that corner; 3-5: the edge from corner 0-2 to the next; 6: inside the facet
  };
  Nearest nearest(const Vec3& p) const;

  TriangleMesh mesh_;
  SphereTree tree_;
  std::vector<Vec3> facet_normals_, corner_normals_;  // by facet, by vertex
  std::vector<std::array<Vec3, 3>> edge_normals_;     // by facet and edge
};

/// Unit normals of the facets; zero for a facet without area.
std::vector<Vec3> facet_normals(const TriangleMesh& mesh);

/// Unit normals of the vertices: those of the facets around them, weighted by their angles there.
std::vector<Vec3> vertex_normals(const TriangleMesh& mesh);

}  // namespace trackbed
