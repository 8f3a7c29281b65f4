// Filling a solid with overlapping spheres, controlled by Distance and Ratio (Taghavi 2011).
#pragma once

#include <numbers>
#include <vector>

#include "geom/clump_template.h"
#include "geom/mesh.h"

namespace trackbed {

struct ClumpFilling {
  double distance = 150 * std::numbers::pi / 180;  // largest angle between two pebbles [rad], 0 to pi: the
                                                   // larger, the more pebbles and the smoother the surface
  double ratio = 0.3;   // smallest pebble radius / largest, above 0 up to 1: the larger, the fewer pebbles
  int max_pebbles = 0;  // stop there; 0 for no limit
  double radius_factor = 1.05;  // a pebble's radius is at most this times its centre's depth
  bool enlarge = false;  // make_stone: scale the pebbles about the centre of mass to the volume of the solid
  int samples = 0;       // points on the surface to look from; 0 for a number that suits the rest
};

/// Angle between two spheres [rad]: 0 when they touch from outside (or are apart), pi when one touches the
/// other from inside. Radius vectors to a point of their common circle enclose pi minus this angle.
double angle_between(const Pebble& a, const Pebble& b);

/// Pebbles in the mesh's frame, largest first. Candidates are the balls that touch the surface in two places
/// (shrinking ball, Ma, Bae & Choi 2012); from the largest down, one is kept unless its angle with a pebble
/// already kept exceeds Distance. The mesh must be a solid. Throws InputError for parameters out of range.
std::vector<Pebble> fill_with_pebbles(const TriangleMesh& solid, const ClumpFilling& filling);

}  // namespace trackbed
