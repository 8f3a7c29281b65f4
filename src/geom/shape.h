// Numbers that describe a stone's form.
#pragma once

#include "geom/mesh.h"

namespace trackbed {

struct Shape {
  double length = 0, breadth = 0, thickness = 0;  // L >= I >= S: edges of the box of least volume [m]
  Mat3 box_axes = Mat3::Identity();               // columns: directions of L, I, S
  double elongation = 0;                          // I / L, 1 for a cube
  double flatness = 0;                            // S / I, 1 for a cube
  double sphericity = 0;  // area of the ball of equal volume / area (Wadell), 1 for a ball
  double convexity = 0;   // volume / volume of the convex hull
  double roundness =
      0;  // 4 pi area / perimeter^2 of the outline, mean of the views along L, I and S: 1 for a ball
  double sieve_size = 0;  // side of the smallest square hole the stone passes [m]
};

/// Measures a solid. It passes a hole in the direction in which the smallest square around its shadow is
/// least; turning it on the way through is not considered. Box and sieve size come from a fixed search over
/// directions, refined around the best: upper bounds, in practice within 0.5 %.
Shape measure_shape(const TriangleMesh& solid);

/// Area [m^2] and perimeter [m] of the outline of a solid seen along a direction. The outline is taken as
/// seen from the middle of the shadow, in 720 directions and through all its corners: exact where every ray
/// from there leaves the shadow once, as those of stones do but for folds in their uneven surface.
struct Outline {
  double area = 0, perimeter = 0;
  /// The roundness index of Janoo (1998).
  double roundness() const;
};
Outline outline_along(const TriangleMesh& solid, const Vec3& direction);

/// The convex hull of the mesh's vertices. Throws InputError when they lie in a plane.
TriangleMesh convex_hull(const TriangleMesh& mesh);

}  // namespace trackbed
