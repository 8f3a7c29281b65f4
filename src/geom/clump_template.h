// A clump template: one stone shape, stored once, however many stones have it.
#pragma once

#include <string>
#include <vector>

#include "base/vec.h"
#include "geom/mesh.h"
#include "geom/sphere_tree.h"

namespace trackbed {

/// One sphere of a clump, in the frame of the clump's principal axes with the origin at its centre of mass.
struct Pebble {
  Vec3 centre;    // [m]
  double radius;  // [m]
};

/// A stone shape as the engine sees it: pebbles for contact, mass properties of the mesh (not of the
/// overlapping pebbles). Everything is for scale 1; a clump of scale s has lengths x s, mass x s^3,
/// inertia x s^5.
struct ClumpTemplate {
  std::string name;
  std::vector<Pebble> pebbles;  // in the order of the tree's leaves
  SphereTree tree;              // bounding spheres over the pebbles
  TriangleMesh surface;         // the stone's mesh in the same frame; empty for a ball made from a radius
  double volume = 0;            // of the mesh [m^3]
  double pebble_volume = 0;     // of the union of the pebbles [m^3]
  Vec3 inertia = Vec3::Zero();  // principal moments at density 1 [m^5], ascending
  double bounding_radius = 0;   // largest |centre| + radius [m]
  double smallest_radius = 0;   // of a pebble [m]
  double sieve_size = 0;        // side of the smallest square hole it passes [m]
};

/// Sorts the pebbles into the tree's order and fills tree and radii; the pebbles are taken to fill the
/// volume. Throws InputError when there is no pebble or a radius is not positive.
ClumpTemplate make_clump_template(std::string name, std::vector<Pebble> pebbles, double volume,
                                  const Vec3& inertia, TriangleMesh surface = {}, double sieve_size = 0);

/// A ball of the given radius [m]: a clump of one pebble.
ClumpTemplate make_ball_template(double radius);

/// One pebble, with volume and inertia of a disc of this thickness [m] about the axis y; the other moments
/// are not asked for, and equal to it.
ClumpTemplate make_disc_template(double radius, double thickness);

/// A ball in the stead of a clump: as large as the union of its pebbles, with its volume and so its weight,
/// which are those of a mesh that the pebbles do not fill.
ClumpTemplate make_stand_in(const ClumpTemplate& clump);

}  // namespace trackbed
