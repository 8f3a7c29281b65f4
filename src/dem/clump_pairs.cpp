// Pairs of stones that lie near each other.
#include <algorithm>
#include <iterator>
#include <numeric>
#include <span>
#include <utility>

#include "dem/pair_blocks.h"
#include "dem/shares.h"

namespace trackbed {
namespace {

using Index = std::size_t;

/// Copies the candidates of one old clump pair behind those of a new one.
void carry_candidates(const PairBlock& from, Index pair, PairBlock& to) {
  const ClumpPair& old = from.pairs[pair];
  to.pairs.back().count = old.count;
  const auto first = old.first, last = old.first + old.count;
  to.keys.insert(to.keys.end(), from.keys.begin() + first, from.keys.begin() + last);
  to.memory.insert(to.memory.end(), from.memory.begin() + first, from.memory.begin() + last);
}

/// Gives back what the growing of the lists has left over.
void fit(PairBlock& block) {
  block.pairs.shrink_to_fit();
  block.keys.shrink_to_fit();
  block.memory.shrink_to_fit();
}

/// Where each pair lies, and which pairs each clump has.
void index_pairs(const Pairs& near, const State& state, Workspace& work) {
  const Index n = static_cast<Index>(state.clumps.size());
  work.first_block_of_patch.clear();
  work.pair_places.clear();
  int patch = -1;
  for (Index b = 0; b < state.pair_blocks.size(); ++b) {
    const PairBlock& block = state.pair_blocks[b];
    for (; patch < block.pairs.front().i / work.patch_size; ++patch)
      work.first_block_of_patch.push_back(static_cast<int>(b));
    work.pair_geometry[b].first_pair = static_cast<int>(work.pair_places.size());
    for (Index k = 0; k < block.pairs.size(); ++k)
      work.pair_places.push_back({static_cast<int>(b), static_cast<int>(k)});
  }
  const Index patches = (n + static_cast<Index>(work.patch_size) - 1) / static_cast<Index>(work.patch_size);
  work.first_block_of_patch.resize(patches + 1, static_cast<int>(state.pair_blocks.size()));

  work.first_pair.assign(n + 1, 0);
  for (const auto& [i, j] : near) ++work.first_pair[static_cast<Index>(i) + 1];
  std::partial_sum(work.first_pair.begin(), work.first_pair.end(), work.first_pair.begin());
  list_by_second(near, n, work.first_entry, work.entries);

  work.sum_of_pair.resize(near.size());
  work.first_sum_of_patch.assign(patches + 1, 0);
  Pairs outer;  // of each sum: the patch it comes from and the clump it goes to
  std::vector<int> last_sum(n, -1);
  for (Index p = 0; p < near.size(); ++p) {
    const int of_i = near[p].first / work.patch_size, j = near[p].second;
    if (of_i == j / work.patch_size) {
      work.sum_of_pair[p] = j;
      continue;
    }
    int& sum = last_sum[static_cast<Index>(j)];
    if (sum < 0 || outer[static_cast<Index>(sum)].first != of_i) {
      sum = static_cast<int>(outer.size());
      outer.emplace_back(of_i, j);
      ++work.first_sum_of_patch[static_cast<Index>(of_i) + 1];
    }
    work.sum_of_pair[p] = static_cast<int>(n) + sum;
  }
  std::partial_sum(work.first_sum_of_patch.begin(), work.first_sum_of_patch.end(),
                   work.first_sum_of_patch.begin());
  for (int& first : work.first_sum_of_patch) first += static_cast<int>(n);
  list_by_second(outer, n, work.first_sum, work.outer_sums);
  for (int& sum : work.outer_sums) sum += static_cast<int>(n);
  work.sums.assign(n + outer.size(), {});
  work.rare_losses.assign(n, {});
}

/// Such that there are hardly more than 32 patches, which most numbers of threads share evenly.
int patch_size_for(int clumps) {
  constexpr int group = static_cast<int>(Watch::group), patches = 32, largest = 1024;
  const int groups = (clumps + patches * group - 1) / (patches * group);
  return std::clamp(groups * group, group, largest);
}

/// Blocks one after the other.
struct BlockRange {
  Index first = 0, end = 0;
};

/// Of each patch, the blocks with pairs of which its clumps are i. When the number of clumps has changed a
/// block may belong to two patches.
std::vector<BlockRange> blocks_of_patches(const std::vector<PairBlock>& blocks, int patch_size,
                                          Index patches) {
  std::vector<BlockRange> ranges(patches);
  for (Index b = 0; b < blocks.size(); ++b) {
    const std::vector<ClumpPair>& pairs = blocks[b].pairs;
    if (pairs.empty()) continue;
    for (int patch = pairs.front().i / patch_size; patch <= pairs.back().i / patch_size; ++patch) {
      BlockRange& range = ranges[static_cast<Index>(patch)];
      if (range.first == range.end) range.first = b;
      range.end = b + 1;
    }
  }
  return ranges;
}

/// The pairs of which clumps of a patch are i.
std::span<const std::pair<int, int>> pairs_of_patch(const Pairs& near, int patch, int patch_size) {
  const auto first = std::ranges::lower_bound(near, std::pair(patch * patch_size, 0));
  const auto last = std::ranges::lower_bound(near, std::pair((patch + 1) * patch_size, 0));
  return {first, last};
}

/// The new blocks of one patch, made of what the old ones hold.
class PatchBlocks {
 public:
  std::vector<PairBlock> blocks;
  std::vector<PairGeometry> geometry;

  void make(std::span<const std::pair<int, int>> near, const BlockRange& old, State& state, Workspace& work) {
    OldPairs<PairBlock> old_pairs(std::span(state.pair_blocks).subspan(old.first, old.end - old.first));
    const bool with_search = work.pair_geometry.size() == state.pair_blocks.size();
    Index released = old.first;
    for (const auto& [i, j] : near) {
      append(i, j);
      const auto found = old_pairs.find({i, j});
      // Old and new pairs of a large bed at once would be half of all its memory.
      for (; released < old.first + old_pairs.block(); ++released)
        if (is_own(state.pair_blocks[released], work.patch_size)) {
          state.pair_blocks[released] = {};
          if (with_search) work.pair_geometry[released] = {};
        }
      if (!found) continue;
      const Index block = old.first + found->first;
      carry_candidates(state.pair_blocks[block], found->second, blocks.back());
      if (with_search) carry_search(work.pair_geometry[block], found->second);
    }
    if (!blocks.empty()) fit(blocks.back());
  }

 private:
  void append(int i, int j) {
    if (blocks.empty() ||
        (i != blocks.back().pairs.back().i && blocks.back().pairs.size() >= PairBlock::full)) {
      if (!blocks.empty()) fit(blocks.back());
      blocks.emplace_back();
      geometry.emplace_back();
    }
    blocks.back().pairs.push_back({i, j, static_cast<int>(blocks.back().keys.size()), 0});
    geometry.back().watch.add(i);
    geometry.back().watch.add(j);
    geometry.back().search.emplace_back();
    geometry.back().due.push_back(-1);
  }

  /// Whether no other patch looks at this old block.
  bool is_own(const PairBlock& old, int patch_size) const {
    const int patch = blocks.back().pairs.back().i / patch_size;
    return !old.pairs.empty() && old.pairs.front().i / patch_size == patch &&
           old.pairs.back().i / patch_size == patch;
  }

  /// What is known of an old pair, for the new one.
  void carry_search(PairGeometry& old, Index pair) {
    geometry.back().search.back() = old.search[pair];
    geometry.back().due.back() = old.due[pair];
    if (pair >= old.near.size()) return;
    geometry.back().near.resize(geometry.back().due.size());
    geometry.back().near.back() = std::move(old.near[pair]);
  }
};

}  // namespace

void rebuild_clump_pairs(State& state, Workspace& work) {
  const Pairs near = near_clumps(state.clumps, work);
  work.patch_size = patch_size_for(state.clumps.size());
  const int patches = (state.clumps.size() + work.patch_size - 1) / work.patch_size;
  const auto old = blocks_of_patches(state.pair_blocks, work.patch_size, static_cast<Index>(patches));
  std::vector<PatchBlocks> made(old.size());
  for_all_shares(patches, [&](const Share& own) {
    for (int patch = own.first; patch < own.last; ++patch) {
      const Index p = static_cast<Index>(patch);
      made[p].make(pairs_of_patch(near, patch, work.patch_size), old[p], state, work);
    }
  });
  state.pair_blocks.clear();
  work.pair_geometry.clear();
  for (PatchBlocks& of_patch : made) {
    std::ranges::move(of_patch.blocks, std::back_inserter(state.pair_blocks));
    std::ranges::move(of_patch.geometry, std::back_inserter(work.pair_geometry));
  }
  index_pairs(near, state, work);
}

}  // namespace trackbed
