// Level one of the search: pairs of stones, and of stones and walls, that lie near each other, kept in
// blocks.
#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <optional>
#include <utility>

#include "dem/inspect.h"
#include "dem/near.h"
#include "dem/search.h"

namespace trackbed {
namespace {

using Index = std::size_t;

std::pair<int, int> key_of(const ClumpPair& p) {
  return {p.i, p.j};
}
std::pair<int, int> key_of(const WallPair& p) {
  return {p.wall, p.clump};
}

/// Finds pairs in blocks when they are asked for in the ascending order in which they lie there.
template <class Block>
class OldPairs {
 public:
  explicit OldPairs(const std::vector<Block>& blocks) : blocks_(blocks) {}

  /// Block and place in it; nothing when the pair is new.
  std::optional<std::pair<Index, Index>> find(const std::pair<int, int>& key) {
    for (; block_ < blocks_.size(); ++block_, pair_ = 0) {
      const auto& pairs = blocks_[block_].pairs;
      while (pair_ < pairs.size() && key_of(pairs[pair_]) < key) ++pair_;
      if (pair_ == pairs.size()) continue;
      if (key_of(pairs[pair_]) != key) return std::nullopt;
      return std::pair(block_, pair_);
    }
    return std::nullopt;
  }

  /// Blocks before this one are not asked for any more.
  Index block() const { return block_; }

 private:
  const std::vector<Block>& blocks_;
  Index block_ = 0, pair_ = 0;
};

/// Copies the candidates of one old clump pair behind those of a new one.
void carry(const PairBlock& from, Index pair, PairBlock& to) {
  const ClumpPair& old = from.pairs[pair];
  to.pairs.back().count = old.count;
  const auto first = old.first, last = old.first + old.count;
  to.keys.insert(to.keys.end(), from.keys.begin() + first, from.keys.begin() + last);
  to.memory.insert(to.memory.end(), from.memory.begin() + first, from.memory.begin() + last);
}

/// Lists of the pairs that have a number for their second: first[c] to first[c + 1] in `entries`.
void list_by_second(const Pairs& pairs, Index n, std::vector<int>& first, std::vector<int>& entries) {
  first.assign(n + 1, 0);
  for (const auto& pair : pairs) ++first[static_cast<Index>(pair.second) + 1];
  std::partial_sum(first.begin(), first.end(), first.begin());
  entries.resize(pairs.size());
  std::vector<int> next(first.begin(), first.end() - 1);
  for (Index p = 0; p < pairs.size(); ++p)
    entries[static_cast<Index>(next[static_cast<Index>(pairs[p].second)]++)] = static_cast<int>(p);
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

void rebuild_clump_pairs(State& state, Workspace& work) {
  const Pairs near = near_clumps(state.clumps, work);
  std::vector<PairBlock> blocks;
  std::vector<PairGeometry> geometry;
  const bool with_search = work.pair_geometry.size() == state.pair_blocks.size();
  work.patch_size = patch_size_for(state.clumps.size());
  const auto begins_block = [&](int i) {
    if (blocks.empty()) return true;
    const int last = blocks.back().pairs.back().i;
    return i / work.patch_size != last / work.patch_size ||
           (i != last && blocks.back().pairs.size() >= PairBlock::full);
  };
  OldPairs old_pairs(state.pair_blocks);
  Index released = 0;
  for (const auto& [i, j] : near) {
    if (begins_block(i)) {
      if (!blocks.empty()) fit(blocks.back());
      blocks.emplace_back();
      geometry.emplace_back();
    }
    blocks.back().pairs.push_back({i, j, static_cast<int>(blocks.back().keys.size()), 0});
    geometry.back().watch.add(i);
    geometry.back().watch.add(j);
    geometry.back().search.emplace_back();
    geometry.back().due.push_back(-1);
    const auto found = old_pairs.find({i, j});
    // Old and new pairs of a large bed at once would be half of all its memory.
    for (; released < old_pairs.block(); ++released) {
      state.pair_blocks[released] = {};
      if (with_search) work.pair_geometry[released] = {};
    }
    if (!found) continue;
    carry(state.pair_blocks[found->first], found->second, blocks.back());
    if (!with_search) continue;
    PairGeometry& old = work.pair_geometry[found->first];
    geometry.back().search.back() = old.search[found->second];
    geometry.back().due.back() = old.due[found->second];
    if (found->second >= old.near.size()) continue;
    geometry.back().near.resize(geometry.back().due.size());
    geometry.back().near.back() = std::move(old.near[found->second]);
  }
  state.pair_blocks = std::move(blocks);
  work.pair_geometry = std::move(geometry);
  index_pairs(near, state, work);
}

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

void rebuild_wall_pairs(const Model& model, State& state, Workspace& work) {
  const auto near = near_walls(model, state, work);
  std::vector<WallBlock> blocks;
  const auto begins_block = [&](int wall, int clump) {
    if (blocks.empty()) return true;
    const std::vector<WallPair>& pairs = blocks.back().pairs;
    return pairs.back().wall != wall ||
           (pairs.size() >= WallBlock::full && !are_summed_together({wall, clump}, key_of(pairs.back())));
  };
  OldPairs old_pairs(state.wall_blocks);
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

/// All pebbles as rows.
void list_pebbles(const Model& model, Workspace& work) {
  work.pebbles.clear();
  work.first_pebble.clear();
  work.is_centred.clear();
  for (const ClumpTemplate& t : model.templates) {
    work.is_centred.push_back(
        std::all_of(t.pebbles.begin(), t.pebbles.end(), [](const Pebble& p) { return p.centre.isZero(0); }));
    work.first_pebble.push_back(static_cast<int>(work.pebbles.size()));
    for (const Pebble& p : t.pebbles) work.pebbles.push_back(row_of(p.centre, p.radius));
  }
}

StoneMotion motion_of(const Clumps& clumps, Index c) {
  return {row_of(clumps.position[c], clumps.scale[c]), row_of(clumps.velocity[c], clumps.mass[c]),
          row_of(clumps.angular_velocity[c]), Row::load(clumps.orientation[c].coeffs().data())};
}

/// A margin that lasts some 50 steps, by how long the last one did: wider where stones move far in a step,
/// for making all pairs anew costs more than pairs that are not needed. `mean`: of the bounding radii [m].
double lasting_margin(const Workspace& work, double mean) {
  constexpr double wanted = 50, smallest = 0.15, largest = 0.6;
  if (!work.pairs_are_valid) return smallest * mean;  // thrown away, not used up
  const double lasted = std::max(work.steps_of_pairs, 1);
  return std::clamp(work.margin * wanted / lasted, smallest * mean, largest * mean);
}

/// Skin and margin that suit the stones, where the user gave none; docs/numerics.md.
void choose_search(const Model& model, const State& state, Workspace& work) {
  double sum = 0;
  for (double b : work.bound) sum += b;
  const double mean = work.bound.empty() ? 0.02 : sum / static_cast<double>(state.clumps.size());
  work.skin = model.search.skin > 0 ? model.search.skin : 0.015 * mean;
  work.margin = model.search.margin > 0 ? model.search.margin : lasting_margin(work, mean);
  work.margin = std::max(work.margin, work.skin);
}

}  // namespace

void prepare(const Model& model, const State& state, Workspace& work) {
  const Index n = static_cast<Index>(state.clumps.size());
  const bool is_new = work.motion.size() != n || work.wall_rotation.size() != state.walls.size();
  if (!is_new && work.pairs_are_valid) return;
  list_pebbles(model, work);
  work.motion.resize(n);
  work.bound.resize(n);
  work.swing.resize(n);
  work.travel.resize(n, 0.0);
  work.group_way.assign((n + Watch::group - 1) / Watch::group, 0.0);
  for (Index c = 0; c < n; ++c) {
    const Index shape = static_cast<Index>(state.clumps.shape[c]);
    work.motion[c] = motion_of(state.clumps, c);
    work.bound[c] = model.templates[shape].bounding_radius * state.clumps.scale[c];
    work.swing[c] = work.is_centred[shape] ? 0.0 : work.bound[c];
  }
  work.wall_rotation.resize(state.walls.size());
  work.wall_travel.resize(state.walls.size(), 0.0);
  for (Index w = 0; w < state.walls.size(); ++w)
    work.wall_rotation[w] = state.walls[w].pose.orientation.toRotationMatrix();
  work.pairs_are_valid = false;
}

bool pairs_are_due(const State& state, Workspace& work) {
  if (!work.pairs_are_valid) return true;
  ++work.steps_of_pairs;
  if (work.way + work.wall_way < work.pairs_good_until) return false;
  double shift2 = 0, wall_shift = 0;
  for (Index c = 0; c < work.position_at_build.size(); ++c)
    shift2 = std::max(shift2, (state.clumps.position[c] - work.position_at_build[c]).squaredNorm());
  for (Index w = 0; w < work.wall_travel.size(); ++w)
    wall_shift = std::max(wall_shift, work.wall_travel[w] - work.wall_travel_at_build[w]);
  const double shift = std::sqrt(shift2);
  const double left = work.margin - shift - std::max(shift, wall_shift);
  work.pairs_good_until = work.way + work.wall_way + 0.5 * left;
  // Rather than look again and again, the pairs are made anew when little is left.
  return left < 0.1 * work.margin;
}

void rebuild_pairs(const Model& model, State& state, Workspace& work) {
  inspect(model, state, work);  // a place that is not a number has no cell
  choose_search(model, state, work);
  rebuild_clump_pairs(state, work);
  rebuild_wall_pairs(model, state, work);
  work.position_at_build = state.clumps.position;
  work.wall_travel_at_build = work.wall_travel;
  work.pairs_good_until = work.way + work.wall_way + 0.5 * work.margin;
  work.steps_of_pairs = 0;
  work.pairs_are_valid = true;
}

}  // namespace trackbed
