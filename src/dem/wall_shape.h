// The geometry of walls and bodies, and where a pebble touches them.
#pragma once

#include <array>
#include <cmath>
#include <string>
#include <vector>

#include "base/vec.h"
#include "geom/mesh.h"
#include "geom/sphere_tree.h"

namespace trackbed {

/// A triangle, ready for closest-point questions.
struct Facet {
  Vec3 a, b, c;  // [m], wall frame
  Vec3 normal;   // of its plane, of length 1
  int group;     // named part of the wall it belongs to

  /// Whether the facet's plane, and so the facet, is farther from a point than `reach` [m].
  bool is_beyond(const Vec3& p, double reach) const { return std::abs(normal.dot(p - a)) > reach; }
};

/// A wall in its own frame: a triangle mesh (two-sided), or the unbounded plane z = 0 with the stones above.
struct WallShape {
  std::string name;
  bool is_plane = false;
  std::vector<Facet> facets;  // in the order of the tree's leaves
  SphereTree tree;
  double reach = 0;   // largest distance of a vertex from the origin of the wall frame [m]
  TriangleMesh mesh;  // for output, facets in the user's order; a plane shows a square
};

/// group_of_facet names the part each facet of the mesh belongs to; empty: all belong to part 0.
/// Throws InputError for a mesh without facets, or with a facet without area.
WallShape make_mesh_wall(std::string name, const TriangleMesh& mesh,
                         const std::vector<int>& group_of_facet = {});
WallShape make_plane_wall(std::string name, double shown_half_width);

/// A point where the distance from a pebble's centre to the wall has a local minimum.
struct WallPoint {
  Vec3 point;       // on the wall [m], wall frame
  double distance;  // from the centre [m]
  int facet;        // one that holds the point
};

/// A pebble touches a wall wherever the distance from its centre to the wall has a local minimum below its
/// radius: once on a face however it is cut into triangles, once on a convex edge or tip, once per face in a
/// concave corner. Up to this many at once; beyond, the nearest count.
inline constexpr int max_wall_points = 3;
using WallPoints = std::array<WallPoint, max_wall_points>;

/// Fills `points` with the touching points of a sphere of the given radius; returns how many. `near` lists
/// the facets to look at: every facet closer than the radius must be among them.
int touching_points(const WallShape& shape, const int* near, int n_near, const Vec3& centre, double radius,
                    WallPoints& points);

/// Visits, ascending, the facets of a mesh nearer to `centre` than `radius`, until visit(facet, square of the
/// distance) returns true. Returns whether it did.
template <class Visit>
bool any_near_facet(const WallShape& shape, const Vec3& centre, double radius, Visit&& visit);

/// Closest point of a triangle (Ericson, Real-Time Collision Detection, 5.1.5).
Vec3 closest_point(const Facet& facet, const Vec3& p);

template <class Visit>
bool any_near_facet(const WallShape& shape, const Vec3& centre, double radius, Visit&& visit) {
  return shape.tree.any(
      [&](const Sphere& bound) {
        const double near = bound.radius + radius;
        return (bound.centre - centre).squaredNorm() <= near * near;
      },
      [&](int f) {
        const Facet& facet = shape.facets[static_cast<std::size_t>(f)];
        if (facet.is_beyond(centre, radius)) return false;
        const Vec3 q = closest_point(facet, centre);
        const double distance2 = (q - centre).squaredNorm();
        return distance2 <= radius * radius && visit(f, distance2);
      });
}

}  // namespace trackbed
