#include "fem/hex_mesh.h"

namespace trackbed::fem {

HexNodes HexMesh::cell_nodes(int cell) const {
  HexNodes places;
  const auto& c = cells[static_cast<std::size_t>(cell)];
  for (int a = 0; a < 8; ++a) places.col(a) = nodes[static_cast<std::size_t>(c[static_cast<std::size_t>(a)])];
  return places;
}

SectionNodes section_nodes(const Section& s) {
  SectionNodes nodes;
  nodes.number.assign(static_cast<std::size_t>((s.across + 1) * (s.up + 1)), -1);
  for (int k = 0; k <= s.up; ++k)
    for (int j = 0; j <= s.across; ++j) {
      const bool used = s.material(j - 1, k - 1) >= 0 || s.material(j, k - 1) >= 0 ||
                        s.material(j - 1, k) >= 0 || s.material(j, k) >= 0;
      if (!used) continue;
      nodes.number[static_cast<std::size_t>(k * (s.across + 1) + j)] = static_cast<int>(nodes.grid.size());
      nodes.grid.push_back({j, k});
    }
  return nodes;
}

HexMesh extrude(const Section& s, double x0, double dx, int planes) {
  const SectionNodes of_plane = section_nodes(s);
  const int m = static_cast<int>(of_plane.grid.size());
  HexMesh mesh;
  for (int p = 0; p < planes; ++p)
    for (const auto& [j, k] : of_plane.grid)
      mesh.nodes.emplace_back(x0 + p * dx, s.y0 + j * s.dy, s.z0 + k * s.dz);
  for (int p = 0; p + 1 < planes; ++p)
    for (int k = 0; k < s.up; ++k)
      for (int j = 0; j < s.across; ++j) {
        if (s.material(j, k) < 0) continue;
        auto node = [&](int i, int jj, int kk) {
          return (p + i) * m + of_plane.number[static_cast<std::size_t>(kk * (s.across + 1) + jj)];
        };
        mesh.cells.push_back({node(0, j, k), node(1, j, k), node(1, j + 1, k), node(0, j + 1, k),
                              node(0, j, k + 1), node(1, j, k + 1), node(1, j + 1, k + 1),
                              node(0, j + 1, k + 1)});
        mesh.materials.push_back(s.material(j, k));
      }
  return mesh;
}

HexMesh make_block(const Vec3& low, const Vec3& high, int nx, int ny, int nz) {
  Section s;
  s.across = ny;
  s.up = nz;
  s.y0 = low.y();
  s.z0 = low.z();
  s.dy = (high.y() - low.y()) / ny;
  s.dz = (high.z() - low.z()) / nz;
  s.materials.assign(static_cast<std::size_t>(ny * nz), 0);
  return extrude(s, low.x(), (high.x() - low.x()) / nx, nx + 1);
}

}  // namespace trackbed::fem
