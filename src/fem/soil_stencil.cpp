#include "fem/soil_stencil.h"

#include <algorithm>
#include <map>

namespace trackbed::fem {

namespace {

/// Planes worked on together, so that forces stay in the nearest cache.
constexpr int chunk = 512;

int corner(int i, int j, int k) {
  return 4 * k + (j == 0 ? i : 3 - i);
}

/// Adds K of the element at (ci, cj, ck) from the node (each -1 or 0) to what neighbours at dx give the node.
void add_element(Coefficients& s, const HexMatrix& element, const std::array<int, 3>& cell, int dx) {
  const auto [ci, cj, ck] = cell;
  const int own = corner(-ci, -cj, -ck);
  if (dx < ci || dx > ci + 1) return;
  for (int dk = ck; dk <= ck + 1; ++dk)
    for (int dj = cj; dj <= cj + 1; ++dj) {
      const int other = corner(dx - ci, dj - cj, dk - ck);
      auto& block = s[static_cast<std::size_t>(1 + dj + 3 * (1 + dk))];
      for (int c = 0; c < 3; ++c)
        for (int d = 0; d < 3; ++d)
          block[static_cast<std::size_t>(c)][static_cast<std::size_t>(d)] +=
              element(3 * own + c, 3 * other + d);
    }
}

/// Materials of the four rectangles around a section node: (-1,-1), (0,-1), (-1,0), (0,0).
using Around = std::array<int, 4>;

/// What nodes at dx give a node between layers of elements ci in [from, to].
Coefficients gather(const Around& around, const std::vector<HexMatrix>& elements, int dx, int from, int to) {
  Coefficients s{};
  for (int ci = from; ci <= to; ++ci)
    for (int q = 0; q < 4; ++q) {
      const int material = around[static_cast<std::size_t>(q)];
      if (material >= 0)
        add_element(s, elements[static_cast<std::size_t>(material)], {ci, q % 2 - 1, q / 2 - 1}, dx);
    }
  return s;
}

InnerStencil inner_stencil(const Around& around, const std::vector<HexMatrix>& elements) {
  InnerStencil s{gather(around, elements, 0, -1, 0), {}, {}};
  const Coefficients before = gather(around, elements, -1, -1, 0), after = gather(around, elements, 1, -1, 0);
  for (std::size_t q = 0; q < 9; ++q)
    for (std::size_t c = 0; c < 3; ++c)
      for (std::size_t d = 0; d < 3; ++d) {
        s.even[q][c][d] = (after[q][c][d] + before[q][c][d]) / 2;
        s.odd[q][c][d] = (after[q][c][d] - before[q][c][d]) / 2;
      }
  return s;
}

struct Three {
  const double *x, *y, *z;
};

/// Adds one neighbour's part to the forces of planes from .. to - 1.
void add_inner(const InnerStencil& s, std::size_t q, const Three& u, const std::array<double*, 3>& out,
               int from, int to) {
  const auto &m = s.middle[q], &e = s.even[q], &o = s.odd[q];
  double *fx = out[0], *fy = out[1], *fz = out[2];
  const double mxx = m[0][0], myy = m[1][1], myz = m[1][2], mzy = m[2][1], mzz = m[2][2];
  const double exx = e[0][0], eyy = e[1][1], eyz = e[1][2], ezy = e[2][1], ezz = e[2][2];
  const double oxy = o[0][1], oxz = o[0][2], oyx = o[1][0], ozx = o[2][0];
#pragma omp simd
  for (int i = from; i < to; ++i) {
    const double tx = u.x[i + 1] - u.x[i - 1], ty = u.y[i + 1] - u.y[i - 1], tz = u.z[i + 1] - u.z[i - 1];
    const double sx = u.x[i + 1] + u.x[i - 1], sy = u.y[i + 1] + u.y[i - 1], sz = u.z[i + 1] + u.z[i - 1];
    fx[i] += (mxx * u.x[i] + exx * sx) + (oxy * ty + oxz * tz);
    fy[i] += ((myy * u.y[i] + eyy * sy) + (myz * u.z[i] + eyz * sz)) + oyx * tx;
    fz[i] += ((mzy * u.y[i] + ezy * sy) + (mzz * u.z[i] + ezz * sz)) + ozx * tx;
  }
}

void add_end(const EndStencil& s, std::size_t q, const Three& u, const std::array<double*, 3>& out, int plane,
             int next) {
  const std::array<double, 3> here{u.x[plane], u.y[plane], u.z[plane]},
      beyond{u.x[next], u.y[next], u.z[next]};
  for (std::size_t c = 0; c < 3; ++c)
    for (std::size_t d = 0; d < 3; ++d)
      out[c][plane] += s.here[q][c][d] * here[d] + s.next[q][c][d] * beyond[d];
}

}  // namespace

SoilStencil::SoilStencil(const Soil& soil) : planes_(soil.planes) {
  const double h = soil.input.element_size;
  const HexNodes cube = make_block(Vec3::Zero(), Vec3::Constant(h), 1, 1, 1).cell_nodes(0);
  std::vector<HexMatrix> elements;
  for (const Elastic& solid : soil.materials)
    elements.push_back(hex_stiffness(cube, solid, soil.input.element));

  std::map<Around, int> types;
  const Section& section = soil.section;
  for (const auto& [j, k] : soil.section_nodes.grid) {
    const Around around{section.material(j - 1, k - 1), section.material(j, k - 1),
                        section.material(j - 1, k), section.material(j, k)};
    const auto [at, is_new] = types.try_emplace(around, static_cast<int>(inner_.size()));
    if (is_new) {
      inner_.push_back(inner_stencil(around, elements));
      start_.push_back({gather(around, elements, 0, 0, 0), gather(around, elements, 1, 0, 0)});
      end_.push_back({gather(around, elements, 0, -1, -1), gather(around, elements, -1, -1, -1)});
    }
    Row row{{}, at->second};
    for (int q = 0; q < 9; ++q) {
      const int jj = j + q % 3 - 1, kk = k + q / 3 - 1;
      const bool inside = jj >= 0 && kk >= 0 && jj <= section.across && kk <= section.up;
      row.neighbours[static_cast<std::size_t>(q)] =
          inside ? soil.section_nodes.number[static_cast<std::size_t>(kk * (section.across + 1) + jj)] : -1;
    }
    rows_.push_back(row);
  }
}

void SoilStencil::force(const double* u, int section_node, const std::array<double*, 3>& out) const {
  const Row& r = rows_[static_cast<std::size_t>(section_node)];
  const auto type = static_cast<std::size_t>(r.type);
  for (double* f : out) std::fill(f, f + planes_, 0.0);
  std::array<Three, 9> of{};
  for (std::size_t q = 0; q < 9; ++q)
    if (const int n = r.neighbours[q]; n >= 0) {
      of[q] = {row(u, n, 0), row(u, n, 1), row(u, n, 2)};
      add_end(start_[type], q, of[q], out, 0, 1);
      add_end(end_[type], q, of[q], out, planes_ - 1, planes_ - 2);
    }
  for (int from = 1; from < planes_ - 1; from += chunk)
    for (std::size_t q = 0; q < 9; ++q)
      if (of[q].x) add_inner(inner_[type], q, of[q], out, from, std::min(from + chunk, planes_ - 1));
}

double SoilStencil::diagonal(int section_node, int axis) const {
  const auto a = static_cast<std::size_t>(axis);
  return inner_[static_cast<std::size_t>(rows_[static_cast<std::size_t>(section_node)].type)].middle[4][a][a];
}

}  // namespace trackbed::fem
