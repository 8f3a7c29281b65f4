// Pairs of a stone and a wall that lie near each other.
#include <numeric>
#include <utility>

#include "dem/pair_blocks.h"

namespace trackbed {
namespace {

using Index = std::size_t;

/// Whether two pairs of a wall and a clump share a sum of what they do to the wall. Not by blocks, which
/// depend on when the pairs were made.
bool are_summed_together(const std::pair<int, int>& a, const std::pair<int, int>& b) {
  return a.first == b.first && a.second / WallBlock::group == b.second / WallBlock::group;
}

/// Where each pair of a clump and a wall lies, which of them each clump has, where its effect on the wall
/// goes, and which blocks lie in each patch.
void index_wall_pairs(const Model& model, const Pairs& near, const State& state, Workspace& work) {
  const Index n = static_cast<Index>(state.clumps.size());
  work.wall_results.assign(near.size(), {});
  list_by_second(near, n, work.first_wall_entry, work.wall_entries);

  work.sum_of_wall_pair.resize(near.size());
  work.first_sum_of_wall.assign(model.walls.size() + 1, 0);
  int sums = 0;
  for (Index p = 0; p < near.size(); ++p) {
    if (p == 0 || !are_summed_together(near[p - 1], near[p])) {
      ++sums;
      ++work.first_sum_of_wall[static_cast<Index>(near[p].first) + 1];
    }
    work.sum_of_wall_pair[p] = sums - 1;
  }
  std::partial_sum(work.first_sum_of_wall.begin(), work.first_sum_of_wall.end(),
                   work.first_sum_of_wall.begin());
  work.wall_sums.assign(static_cast<Index>(sums), {});

  work.wall_pair_places.clear();
  Pairs by_patch;  // of each block: itself and the patch
  for (Index b = 0; b < state.wall_blocks.size(); ++b) {
    const std::vector<WallPair>& pairs = state.wall_blocks[b].pairs;
    work.wall_geometry[b].first_pair = static_cast<int>(work.wall_pair_places.size());
    for (Index k = 0; k < pairs.size(); ++k)
      work.wall_pair_places.push_back({static_cast<int>(b), static_cast<int>(k)});
    by_patch.emplace_back(static_cast<int>(b), pairs[pairs.size() / 2].clump / work.patch_size);
  }
  list_by_second(by_patch, static_cast<Index>(work.patches()), work.first_wall_block_of_patch,
                 work.wall_block_order);
}

}  // namespace

void rebuild_wall_pairs(const Model& model, State& state, Workspace& work) {
  const auto near = near_walls(model, state, work);
  std::vector<WallBlock> blocks;
  const auto begins_block = [&](int wall, int clump) {
    if (blocks.empty()) return true;
    const std::vector<WallPair>& pairs = blocks.back().pairs;
    return pairs.back().wall != wall ||
           (pairs.size() >= WallBlock::full && !are_summed_together({wall, clump}, key_of(pairs.back())));
  };
  OldPairs<WallBlock> old_pairs(state.wall_blocks);
  for (const auto& [wall, clump] : near) {
    if (begins_block(wall, clump)) blocks.emplace_back();
    WallBlock& block = blocks.back();
    block.pairs.push_back({clump, wall, static_cast<int>(block.keys.size()), 0});
    const auto found = old_pairs.find({wall, clump});
    if (!found) continue;
    const WallBlock& old = state.wall_blocks[found->first];
    const WallPair& from = old.pairs[found->second];
    block.pairs.back().count = from.count;
    block.keys.insert(block.keys.end(), old.keys.begin() + from.first,
                      old.keys.begin() + from.first + from.count);
    block.memory.insert(block.memory.end(), old.memory.begin() + from.first,
                        old.memory.begin() + from.first + from.count);
  }
  state.wall_blocks = std::move(blocks);
  // Candidates against walls are looked for anew: there are few, and their facet lists are not worth
  // carrying.
  work.wall_geometry.assign(state.wall_blocks.size(), {});
  for (Index b = 0; b < state.wall_blocks.size(); ++b) {
    work.wall_geometry[b].search.resize(state.wall_blocks[b].pairs.size());
    work.wall_geometry[b].tested.resize(state.wall_blocks[b].pairs.size(), 0.0);
    work.wall_geometry[b].due.resize(state.wall_blocks[b].pairs.size(), -1);
    work.wall_geometry[b].candidates.resize(state.wall_blocks[b].keys.size());
    for (const WallPair& p : state.wall_blocks[b].pairs) work.wall_geometry[b].watch.add(p.clump);
  }
  index_wall_pairs(model, near, state, work);
}

}  // namespace trackbed
