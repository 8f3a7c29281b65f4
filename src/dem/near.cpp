#include "dem/near.h"

#include <algorithm>
#include <array>
#include <numeric>
#include <utility>

#include "base/runs.h"

namespace trackbed {
namespace {

using Index = std::size_t;

/// Stones of like sizes sorted into cubic cells.
struct Grid {
  double largest;  // of their bounding radii [m]
  Vec3 origin;
  double cell;
  std::array<int, 3> n;
  std::vector<int> first, members;

  std::array<int, 3> place(const Vec3& p) const {
    std::array<int, 3> at;
    for (int a = 0; a < 3; ++a) {
      const Index k = static_cast<Index>(a);
      at[k] = static_cast<int>(std::clamp((p[a] - origin[a]) / cell, 0.0, n[k] - 1.0));
    }
    return at;
  }
  int number(int x, int y, int z) const { return (z * n[1] + y) * n[0] + x; }
};

/// A grid of some of the stones, with cells of their largest bounding diameter plus margin.
Grid make_grid(const Clumps& clumps, const std::vector<int>& stones, const Workspace& work) {
  Grid grid{0, Vec3::Zero(), 0, {}, {}, {}};
  Eigen::AlignedBox3d box;
  for (int c : stones) {
    box.extend(clumps.position[static_cast<Index>(c)]);
    grid.largest = std::max(grid.largest, work.bound[static_cast<Index>(c)]);
  }
  grid.origin = box.min();
  grid.cell = 2.0 * grid.largest + work.margin;
  // Few stones in a wide space: larger cells, rather than more of them than memory holds.
  const double most = 8.0 * static_cast<double>(stones.size()) + 64.0;
  for (;;) {
    const Vec3 cells = (box.sizes() / grid.cell).array().floor() + 1.0;
    if (cells.prod() <= most) {
      for (int a = 0; a < 3; ++a) grid.n[static_cast<Index>(a)] = static_cast<int>(cells[a]);
      break;
    }
    grid.cell *= 1.5;
  }
  std::vector<int> cell_of(stones.size());
  grid.first.assign(static_cast<Index>(grid.n[0] * grid.n[1] * grid.n[2]) + 1, 0);
  for (Index k = 0; k < stones.size(); ++k) {
    const auto at = grid.place(clumps.position[static_cast<Index>(stones[k])]);
    cell_of[k] = grid.number(at[0], at[1], at[2]);
    ++grid.first[static_cast<Index>(cell_of[k]) + 1];
  }
  std::partial_sum(grid.first.begin(), grid.first.end(), grid.first.begin());
  grid.members.resize(stones.size());
  std::vector<int> next(grid.first.begin(), grid.first.end() - 1);
  for (Index k = 0; k < stones.size(); ++k)
    grid.members[static_cast<Index>(next[static_cast<Index>(cell_of[k])]++)] = stones[k];
  return grid;
}

/// Stones of very different sizes lie in grids of their own: within one, the largest is at most twice as
/// large as the smallest, but in the last, which has all that are smaller still.
std::vector<Grid> make_grids(const Clumps& clumps, const Workspace& work) {
  constexpr int most = 6;
  constexpr double ratio = 2;
  const double largest = *std::max_element(work.bound.begin(), work.bound.end());
  std::array<std::vector<int>, most> levels;
  for (int c = 0; c < clumps.size(); ++c) {
    Index level = 0;
    for (double bound = largest / ratio; work.bound[static_cast<Index>(c)] < bound && level + 1 < most;
         bound /= ratio)
      ++level;
    levels[level].push_back(c);
  }
  std::vector<Grid> grids;
  for (const std::vector<int>& stones : levels)
    if (!stones.empty()) grids.push_back(make_grid(clumps, stones, work));
  return grids;
}

bool is_near(const WallShape& shape, const Vec3& centre, double radius) {
  if (shape.is_plane) return centre.z() < radius;
  return any_near_facet(shape, centre, radius, [](int, double) { return true; });
}

/// Appends the pairs of stone i with those after it that are near it, ascending.
void append_near(int i, const std::vector<Grid>& grids, const Clumps& clumps, const Workspace& work,
                 Pairs& pairs) {
  const Vec3& x = clumps.position[static_cast<Index>(i)];
  const double bound = work.bound[static_cast<Index>(i)];
  const auto before = static_cast<std::ptrdiff_t>(pairs.size());
  for (const Grid& grid : grids) {
    const Vec3 reach = Vec3::Constant(bound + grid.largest + work.margin);
    const auto low = grid.place(x - reach), high = grid.place(x + reach);
    for (int z = low[2]; z <= high[2]; ++z)
      for (int y = low[1]; y <= high[1]; ++y) {
        const int last = grid.first[static_cast<Index>(grid.number(high[0], y, z)) + 1];
        for (int k = grid.first[static_cast<Index>(grid.number(low[0], y, z))]; k < last; ++k) {
          const int j = grid.members[static_cast<Index>(k)];
          if (j <= i) continue;
          const double near = bound + work.bound[static_cast<Index>(j)] + work.margin;
          if ((clumps.position[static_cast<Index>(j)] - x).squaredNorm() < near * near)
            pairs.emplace_back(i, j);
        }
      }
  }
  std::sort(pairs.begin() + before, pairs.end());
}

/// What `append` finds for each of the stones, in their order, whichever thread asks for which.
template <class Append>
Pairs for_all(int stones, const Append& append) {
  constexpr int run = 1024;  // consecutive stones that one thread takes at a time
  std::vector<Pairs> of_run(static_cast<Index>((stones + run - 1) / run));
  for_each_run(of_run.size(), [&](Index r) {
    Pairs own;
    const int first = static_cast<int>(r) * run, end = std::min(first + run, stones);
    for (int i = first; i < end; ++i) append(i, own);
    of_run[r] = std::move(own);
  });
  if (of_run.size() == 1) return std::move(of_run[0]);
  Pairs pairs;
  Index n = 0;
  for (const Pairs& some : of_run) n += some.size();
  pairs.reserve(n);
  for (const Pairs& some : of_run) pairs.insert(pairs.end(), some.begin(), some.end());
  return pairs;
}

}  // namespace

Pairs near_clumps(const Clumps& clumps, const Workspace& work) {
  if (clumps.size() < 2) return {};
  const std::vector<Grid> grids = make_grids(clumps, work);
  return for_all(clumps.size(), [&](int i, Pairs& pairs) { append_near(i, grids, clumps, work, pairs); });
}

Pairs near_walls(const Model& model, const State& state, const Workspace& work) {
  Pairs pairs;
  for (Index w = 0; w < model.walls.size(); ++w) {
    if (!state.walls[w].present) continue;
    const Pairs of_wall = for_all(state.clumps.size(), [&](int c, Pairs& near) {
      const Index k = static_cast<Index>(c);
      const Vec3 centre = state.walls[w].pose.to_body(state.clumps.position[k]);
      if (is_near(model.walls[w].shape, centre, work.bound[k] + work.margin))
        near.emplace_back(static_cast<int>(w), c);
    });
    pairs.insert(pairs.end(), of_wall.begin(), of_wall.end());
  }
  return pairs;
}

}  // namespace trackbed
