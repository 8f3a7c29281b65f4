// From elements to sparse matrices of the free displacements.
#pragma once

#include <Eigen/SparseCore>
#include <array>
#include <vector>

#include "fem/hex_mesh.h"

namespace trackbed::fem {

using SparseMatrix = Eigen::SparseMatrix<double>;

/// Which displacements of a mesh are free, and their numbers.
class Freedoms {
 public:
  explicit Freedoms(int nodes) : number_(static_cast<std::size_t>(3 * nodes), 0) {}
  /// Holds a displacement at zero; axis 0 to 2. Call number() when all are held.
  void hold(int node, int axis) { number_[static_cast<std::size_t>(3 * node + axis)] = -1; }
  void hold_all(int node) {
    for (int axis = 0; axis < 3; ++axis) hold(node, axis);
  }
  /// Numbers what is free, node after node; returns how many.
  int number();

  int size() const { return size_; }
  int nodes() const { return static_cast<int>(number_.size() / 3); }
  /// -1 when held.
  int operator()(int node, int axis) const { return number_[static_cast<std::size_t>(3 * node + axis)]; }

 private:
  std::vector<int> number_;
  int size_ = 0;
};

/// Stiffness of the free displacements [N/m], both triangles.
SparseMatrix assemble_stiffness(const HexMesh&, const std::vector<Elastic>&, HexKind, const Freedoms&);

/// Consistent mass [kg], both triangles.
SparseMatrix assemble_mass(const HexMesh&, const std::vector<Elastic>&, const Freedoms&);

/// Lumped mass of every node [kg].
Eigen::VectorXd lumped_node_masses(const HexMesh&, const std::vector<Elastic>&);

/// One value a node, for its free displacements.
Eigen::VectorXd to_freedoms(const Eigen::VectorXd& of_nodes, const Freedoms&);

/// Displacements of all nodes, three together, from the free ones.
Eigen::VectorXd to_nodes(const Eigen::VectorXd& of_freedoms, const Freedoms&);

}  // namespace trackbed::fem
