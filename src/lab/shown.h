// The shapes that pictures and ParaView show: fine enough for the eye, no finer.
#pragma once

#include <vector>

#include "io/vtk.h"
#include "lab/simulation.h"

namespace trackbed {

/// A surface for each template, in its frame at scale 1: the stone's mesh, or for a template without mesh its
/// pebbles as balls; the coarser the more of these `stones` there are to show.
std::vector<TriangleMesh> shown_surfaces(const Model& model, int stones);

/// The stones where they are; `surfaces` must live as long.
std::vector<PosedMesh> posed_stones(const State& state, const std::vector<TriangleMesh>& surfaces);

/// The mesh with all vertices of each cubic cell merged into one at their mean.
TriangleMesh merge_vertices(const TriangleMesh& mesh, double cell);

}  // namespace trackbed
