// Level one of the search: pairs of stones, and of stones and walls, that lie near each other, kept in
// blocks.
#pragma once

#include <cstddef>
#include <numeric>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "dem/near.h"

namespace trackbed {

/// Makes all blocks of pairs of stones anew; what was known of the pairs that stay is kept.
void rebuild_clump_pairs(State& state, Workspace& work);

/// The same for pairs of a stone and a wall.
void rebuild_wall_pairs(const Model& model, State& state, Workspace& work);

inline std::pair<int, int> key_of(const ClumpPair& p) {
  return {p.i, p.j};
}
inline std::pair<int, int> key_of(const WallPair& p) {
  return {p.wall, p.clump};
}

/// Finds pairs in blocks when they are asked for in the ascending order in which they lie there.
template <class Block>
class OldPairs {
 public:
  explicit OldPairs(std::span<const Block> blocks) : blocks_(blocks) {}

  /// Block and place in it; nothing when the pair is new.
  std::optional<std::pair<std::size_t, std::size_t>> find(const std::pair<int, int>& key) {
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
  std::size_t block() const { return block_; }

 private:
  std::span<const Block> blocks_;
  std::size_t block_ = 0, pair_ = 0;
};

/// Lists of the pairs that have a number for their second: first[c] to first[c + 1] in `entries`.
inline void list_by_second(const Pairs& pairs, std::size_t n, std::vector<int>& first,
                           std::vector<int>& entries) {
  first.assign(n + 1, 0);
  for (const auto& pair : pairs) ++first[static_cast<std::size_t>(pair.second) + 1];
  std::partial_sum(first.begin(), first.end(), first.begin());
  entries.resize(pairs.size());
  std::vector<int> next(first.begin(), first.end() - 1);
  for (std::size_t p = 0; p < pairs.size(); ++p)
    entries[static_cast<std::size_t>(next[static_cast<std::size_t>(pairs[p].second)]++)] =
        static_cast<int>(p);
}

}  // namespace trackbed
