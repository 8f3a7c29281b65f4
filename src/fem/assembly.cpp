#include "fem/assembly.h"

namespace trackbed::fem {

namespace {

/// Calls of `matrix_of` for cells of the same material and shape, as meshes of bricks are full of, are
/// spared.
template <class MatrixOf>
SparseMatrix assemble(const HexMesh& mesh, const Freedoms& freedoms, MatrixOf matrix_of) {
  struct Known {
    int material;
    HexNodes shape;
    HexMatrix matrix;
  };
  std::vector<Known> known;
  auto find = [&](int cell) -> const HexMatrix& {
    HexNodes shape = mesh.cell_nodes(cell);
    const double tolerance = 1e-9 * (shape.col(6) - shape.col(0)).norm();
    shape.colwise() -= shape.col(0).eval();
    const int material = mesh.materials[static_cast<std::size_t>(cell)];
    for (const Known& k : known)
      if (k.material == material && (k.shape - shape).cwiseAbs().maxCoeff() < tolerance) return k.matrix;
    if (known.size() > 8) known.erase(known.begin());
    known.push_back({material, shape, matrix_of(shape, material)});
    return known.back().matrix;
  };

  std::vector<Eigen::Triplet<double>> entries;
  entries.reserve(mesh.cells.size() * 576);
  for (std::size_t c = 0; c < mesh.cells.size(); ++c) {
    const HexMatrix& matrix = find(static_cast<int>(c));
    std::array<int, 24> at;
    for (std::size_t a = 0; a < 24; ++a) at[a] = freedoms(mesh.cells[c][a / 3], static_cast<int>(a % 3));
    for (std::size_t a = 0; a < 24; ++a)
      for (std::size_t b = 0; b < 24; ++b) {
        const double value = matrix(static_cast<int>(a), static_cast<int>(b));
        if (at[a] >= 0 && at[b] >= 0 && value != 0) entries.emplace_back(at[a], at[b], value);
      }
  }
  SparseMatrix m(freedoms.size(), freedoms.size());
  m.setFromTriplets(entries.begin(), entries.end());
  return m;
}

}  // namespace

int Freedoms::number() {
  size_ = 0;
  for (int& n : number_)
    if (n >= 0) n = size_++;
  return size_;
}

SparseMatrix assemble_stiffness(const HexMesh& mesh, const std::vector<Elastic>& solids, HexKind kind,
                                const Freedoms& freedoms) {
  return assemble(mesh, freedoms, [&](const HexNodes& shape, int material) {
    return hex_stiffness(shape, solids[static_cast<std::size_t>(material)], kind);
  });
}

SparseMatrix assemble_mass(const HexMesh& mesh, const std::vector<Elastic>& solids,
                           const Freedoms& freedoms) {
  return assemble(mesh, freedoms, [&](const HexNodes& shape, int material) {
    return hex_mass(shape, solids[static_cast<std::size_t>(material)].density);
  });
}

Eigen::VectorXd lumped_node_masses(const HexMesh& mesh, const std::vector<Elastic>& solids) {
  Eigen::VectorXd m = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(mesh.nodes.size()));
  for (std::size_t c = 0; c < mesh.cells.size(); ++c) {
    const double density = solids[static_cast<std::size_t>(mesh.materials[c])].density;
    const auto masses = hex_lumped_mass(mesh.cell_nodes(static_cast<int>(c)), density);
    for (std::size_t a = 0; a < 8; ++a) m[mesh.cells[c][a]] += masses[static_cast<int>(a)];
  }
  return m;
}

Eigen::VectorXd to_freedoms(const Eigen::VectorXd& of_nodes, const Freedoms& freedoms) {
  Eigen::VectorXd v(freedoms.size());
  for (int n = 0; n < freedoms.nodes(); ++n)
    for (int axis = 0; axis < 3; ++axis)
      if (freedoms(n, axis) >= 0) v[freedoms(n, axis)] = of_nodes[n];
  return v;
}

Eigen::VectorXd to_nodes(const Eigen::VectorXd& of_freedoms, const Freedoms& freedoms) {
  Eigen::VectorXd u = Eigen::VectorXd::Zero(3 * freedoms.nodes());
  for (int n = 0; n < freedoms.nodes(); ++n)
    for (int axis = 0; axis < 3; ++axis)
      if (freedoms(n, axis) >= 0) u[3 * n + axis] = of_freedoms[freedoms(n, axis)];
  return u;
}

}  // namespace trackbed::fem
