// One stone from mesh to clump template.
#pragma once

#include <string>

#include "geom/clump_error.h"
#include "geom/clump_fill.h"
#include "geom/clump_template.h"
#include "geom/shape.h"

namespace trackbed {

struct Stone {
  ClumpTemplate clump;  // about the centre of mass, along the principal axes
  Shape shape;
  ClumpError error;
};

/// Fills a solid with pebbles and moves all to its principal frame. Volume, centre and inertia are those of
/// the mesh; so is the volume of the pebbles when they are enlarged. The mesh must come from make_solid.
/// Throws InputError, naming the stone, when it cannot be filled.
Stone make_stone(const TriangleMesh& solid, const std::string& name, const ClumpFilling& filling);

}  // namespace trackbed
