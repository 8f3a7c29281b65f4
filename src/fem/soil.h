// The ground under the sleepers of an embankment: ballast and subgrade, one linear elastic solid with ports.
//
// A port ("footing") is the rectangle of surface nodes under one sleeper. The track sees of the soil only the
// vertical displacements of the footings' nodes and gives it vertical forces there. All vectors over footing
// nodes hold footing after footing; in a footing the nodes along the track come first, then the rows across
// from y low to y high:
//     entry = footing * nodes_per_footing + row * nodes_along + node
// z points up: a sleeper that presses gives negative forces and finds negative displacements. In a half model
// (symmetric about y = 0, the default) a footing is half a sleeper's base and forces are those of that half;
// nodes on y = 0 carry half of what they would carry in the whole.
//
// Two forms of the same soil:
//   ExplicitSoil (explicit_soil.h)   full order, central differences, matrix-free
//   ReducedSoil  (reduced_soil.h)    M q'' + C q' + K q = P^T f,  u = P q,  few unknowns, implicit
#pragma once

#include <vector>

#include "fem/hex_mesh.h"

namespace trackbed::fem {

/// What holds a face of the soil.
enum class Support {
  free,      ///< nothing
  roller,    ///< no displacement across the face
  fixed,     ///< no displacement
  absorbing  ///< dashpots rho c_p across and rho c_s along the face (Lysmer & Kuhlemeyer 1969), no stiffness
};

/// What a soil is made from. Where the thesis tells nothing (densities, width and depth of the ground,
/// boundaries, damping), the defaults are ours, with the reason beside them.
struct SoilInput {
  Elastic ballast{1.2e8, 0.2, 1800};   // Jia (2023), table 6-1; density of packed stones
  Elastic subgrade{1.8e8, 0.2, 1900};  // the same; density of sand
  HexKind element = HexKind::b_bar;    // as in the thesis
  double element_size = 0.075;  // edge of the cubic elements [m], as in the thesis; all lengths are multiples
  double length = 48;           // along x, from x = 0 [m]
  double ballast_depth = 0.3;   // under the sleepers' bases [m]
  double subgrade_depth = 0.975;  // [m]; from 0.3 m to 2 m a sleeper's share of an axle changes by 3 % only
  double half_width = 1.8;        // from the middle of the track to the side of the ground [m]
  double crest = 1.8;             // half width of the top of the ballast [m], half_width at most
  double shoulder_slope = 1.5;  // of the ballast beside the crest, across : down [-]; in steps of an element
  bool whole_width = false;     // both halves instead of the symmetric half y >= 0
  Support start = Support::absorbing;  // face x = 0: the embankment goes on
  Support end = Support::free;         // face x = length: the joint beside the abutment
  Support side = Support::roller;      // outermost face of the ground: it goes on, and confines
  Support base = Support::fixed;       // ground below is stiff
  double mass_damping = 0;             // a of Rayleigh damping C = a M + b K [1/s]
  double stiffness_damping = 0;        // b [s]

  int sleepers = 80;
  double first_sleeper = 0.3375;  // middle of the first footing [m]; its edges are put on the nearest nodes
  double sleeper_spacing = 0.6;   // [m], a multiple of element_size
  double sleeper_width = 0.225;   // along the track [m]: 3 elements
  double sleeper_half_length = 1.2;  // across [m]
};

/// The soil's mesh and footings, the same for both forms.
struct Soil {
  SoilInput input;
  Section section;
  SectionNodes section_nodes;
  int planes = 0;                  // of nodes along x, element_size apart
  std::vector<Elastic> materials;  // 0 ballast, 1 subgrade

  int nodes_along = 0, nodes_across = 0;   // of a footing
  std::vector<int> first_plane;            // of each footing: plane of its first nodes
  std::vector<int> footing_section_nodes;  // section node of each row of a footing

  /// Pressure shapes s of a footing: products of Legendre polynomials 0 to 2 across (each half of a whole
  /// sleeper by itself) and 0 to 1 along, orthonormal under the nodes' areas: shapes^T diag(area) shapes = 1.
  /// shape_forces = diag(area) shapes: the forces of nodes of unit pressure shapes [m] and, transposed, what
  /// takes displacements of nodes to those of shapes, u ~ shapes (shape_forces^T u).
  Eigen::MatrixXd shapes, shape_forces;  // nodes_per_footing x 6 (12 for a whole width), [1/m] and [m]
  Eigen::VectorXd area;                  // of each node of a footing [m2]

  int footings() const { return static_cast<int>(first_plane.size()); }
  int nodes_per_footing() const { return nodes_along * nodes_across; }
  int section_size() const { return static_cast<int>(section_nodes.grid.size()); }
  int nodes() const { return planes * section_size(); }
  /// The node of the extruded mesh behind an entry of vectors over footing nodes.
  int node(int footing, int along, int row) const {
    return (first_plane[static_cast<std::size_t>(footing)] + along) * section_size() +
           footing_section_nodes[static_cast<std::size_t>(row)];
  }
  double x_of(int footing) const;  // middle [m]

  /// Do the supports, or symmetry, hold this displacement at zero?
  bool is_held(int plane, int section_node, int axis) const;
  /// Dashpots of absorbing faces at a node, along each axis [N s/m].
  Vec3 dashpot(int plane, int section_node) const;
  /// Lumped mass of a node [kg].
  double mass(int plane, int section_node) const;
};

/// Throws InputError that names the key when lengths are no multiples of the element size, or a footing does
/// not lie on the ballast or reaches over an end.
Soil make_soil(const SoilInput&);

}  // namespace trackbed::fem
