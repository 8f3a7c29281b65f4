// Level two of the search for two stones: their two trees are walked against each other.
#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "dem/pair_motion.h"
#include "dem/search.h"
#include "dem/two_stones.h"

namespace trackbed {
namespace {

using Index = std::size_t;

/// Per-thread memory of a search, kept from call to call so that a step allocates nothing.
struct Scratch {
  std::vector<PebblePair> found;
  std::vector<ContactMemory> memory;
};

Scratch& scratch() {
  thread_local Scratch memory;
  return memory;
}

// Not a function, which sorting would call through a pointer.
constexpr auto is_before = [](const PebblePair& x, const PebblePair& y) {
  return x.a != y.a ? x.a < y.a : x.b < y.b;
};

/// Pebble pairs with no more than the skin between them.
void walk_trees(const TwoStones& two, double skin, Scratch& s) {
  s.found.clear();
  two.any_within(skin, [&](int a, int b) {
    s.found.push_back({a, b});
    return false;
  });
  std::sort(s.found.begin(), s.found.end(), is_before);
}

/// Those of a list with no more than the skin between them.
void prune(const TwoStones& two, double skin, const std::vector<PebblePair>& list, Scratch& s) {
  s.found.clear();
  for (const PebblePair& p : list)
    if (two.are_within(skin, p.a, p.b)) s.found.push_back(p);
}

/// Adds the candidates that touched in the last step, however far they are now: their contacts have yet to be
/// ended, and their energy booked. Sorts all.
void keep_touching(const PairBlock& block, const ClumpPair& p, Scratch& s) {
  const Index n = s.found.size();
  for (Index k = static_cast<Index>(p.first); k < static_cast<Index>(p.first + p.count); ++k)
    if (block.memory[k].touches() &&
        !std::binary_search(s.found.begin(), s.found.begin() + static_cast<std::ptrdiff_t>(n), block.keys[k],
                            is_before))
      s.found.push_back(block.keys[k]);
  if (s.found.size() > n) std::sort(s.found.begin(), s.found.end(), is_before);
}

/// Puts the found candidates in the place of the pair's old ones; touching contacts keep their memory.
void replace_candidates(Index pair, Scratch& s, PairBlock& block) {
  ClumpPair& p = block.pairs[pair];
  const Index n = s.found.size();
  s.memory.assign(n, {});
  Index old = static_cast<Index>(p.first);
  const Index old_end = old + static_cast<Index>(p.count);
  for (Index k = 0; k < n; ++k) {
    while (old < old_end && is_before(block.keys[old], s.found[k])) ++old;
    if (old < old_end && !is_before(s.found[k], block.keys[old])) s.memory[k] = block.memory[old];
  }
  const auto splice = [&](auto& into, const auto& from) {
    const auto first = into.begin() + p.first;
    const auto common = std::min(static_cast<std::ptrdiff_t>(n), static_cast<std::ptrdiff_t>(p.count));
    std::copy(from.begin(), from.begin() + common, first);
    if (n > static_cast<Index>(p.count))
      into.insert(first + common, from.begin() + common, from.end());
    else
      into.erase(first + common, first + p.count);
  };
  splice(block.keys, s.found);
  splice(block.memory, s.memory);
  const int more = static_cast<int>(n) - p.count;
  p.count = static_cast<int>(n);
  for (Index later = pair + 1; later < block.pairs.size(); ++later) block.pairs[later].first += more;
}

/// A pair of a block that is due.
struct DuePair {
  PairBlock& block;
  PairGeometry& geometry;
  Index pair;
};

/// The candidates of two stones: from the list of what was near when the trees were last walked, or by a walk
/// if that list is too old. `reach`: in which turning moves pebbles of stone j [m].
void find_candidates(const TwoStones& two, const Skin& skin, const Relative& now, double reach,
                     const DuePair& due, Scratch& s) {
  if (skin.inner == skin.outer) return walk_trees(two, skin.outer, s);
  if (due.geometry.near.size() < due.block.pairs.size()) due.geometry.near.resize(due.block.pairs.size());
  NearPebbles& near = due.geometry.near[due.pair];
  if (near.search.range < skin.inner + motion_since(near.search, now, reach)) {
    walk_trees(two, skin.outer, s);
    near.pairs.assign(s.found.begin(), s.found.end());
    near.search = {now.turn, now.offset, skin.outer};
  }
  prune(two, skin.inner, near.pairs, s);
}

/// Measures how far the two stones have moved; looks for their candidates if that is too far. Returns whether
/// the pair's list is a new one.
bool search_pair(const Model& model, const State& state, const Workspace& work, const DuePair& due) {
  const Clumps& c = state.clumps;
  const ClumpPair& pair = due.block.pairs[due.pair];
  PairSearch& search = due.geometry.search[due.pair];
  const Index i = static_cast<Index>(pair.i), j = static_cast<Index>(pair.j);
  const double travel = work.travel[i] + work.travel[j];
  // Turning moves nothing of a ball: its frame may as well stand still.
  const auto turn = [&](Index k) { return work.swing[k] > 0 ? c.orientation[k] : Quat::Identity(); };
  const Relative now = relative_pose(c.position[i], turn(i), c.position[j], turn(j));
  const double left = search.range - motion_since(search, now, work.swing[j]);
  if (left > nearly_used_up * search.range) {
    due.geometry.due[due.pair] = travel + left;
    return false;
  }
  const double apart = now.offset.norm() - work.bound[i] - work.bound[j];
  const TwoStones two(model, c, pair.i, pair.j, now);
  Skin skin = skin_of(state, work, speed_of(state, work, i) + speed_of(state, work, j));
  if (two.are_simple()) skin.inner = skin.outer;  // nothing to choose from
  scratch().found.clear();
  if (apart <= skin.inner)
    find_candidates(two, skin, now, work.swing[j], due, scratch());
  else if (due.pair < due.geometry.near.size())
    due.geometry.near[due.pair] = {};
  const bool has_list = apart <= skin.inner || pair.count > 0;
  if (has_list) {
    keep_touching(due.block, pair, scratch());
    replace_candidates(due.pair, scratch(), due.block);
  }
  // Stones that are far apart touch no sooner than when they have come nearer by that much.
  const double range = std::max(apart, skin.inner);
  search = {now.turn, now.offset, range};
  due.geometry.due[due.pair] = travel + range;
  return has_list;
}

/// The block's candidates as the forces want them.
void list_candidates(const Model& model, const State& state, const Workspace& work, const PairBlock& block,
                     PairGeometry& geometry) {
  const Clumps& c = state.clumps;
  const auto is_centred = [&](Index clump) {
    return work.is_centred[static_cast<Index>(c.shape[clump])] != 0;
  };
  geometry.candidates.clear();
  geometry.is_centred = true;
  for (Index p = 0; p < block.pairs.size(); ++p) {
    const ClumpPair& pair = block.pairs[p];
    if (pair.count == 0) continue;
    const Index i = static_cast<Index>(pair.i), j = static_cast<Index>(pair.j);
    const int first_a = work.first_pebble[static_cast<Index>(c.shape[i])];
    const int first_b = work.first_pebble[static_cast<Index>(c.shape[j])];
    const int sum_j = work.sum_of_pair[static_cast<Index>(geometry.first_pair) + p];
    const int properties = model.pairs.index(c.material[i], c.material[j]);
    geometry.is_centred = geometry.is_centred && is_centred(i) && is_centred(j);
    for (Index k = static_cast<Index>(pair.first); k < static_cast<Index>(pair.first + pair.count); ++k) {
      const int a = first_a + block.keys[k].a, b = first_b + block.keys[k].b;
      geometry.candidates.push_back({pair.i, pair.j, a, b, sum_j, properties});
    }
  }
}

}  // namespace

void refresh(const Model& model, const State& state, const Workspace& work, PairBlock& block,
             PairGeometry& geometry) {
  double least = std::numeric_limits<double>::infinity();
  bool is_new = geometry.candidates.size() != block.keys.size();
  for (Index k = 0; k < block.pairs.size(); ++k) {
    const Index i = static_cast<Index>(block.pairs[k].i), j = static_cast<Index>(block.pairs[k].j);
    const double travel = work.travel[i] + work.travel[j];
    if (travel > geometry.due[k]) is_new |= search_pair(model, state, work, {block, geometry, k});
    least = std::min(least, geometry.due[k] - travel);
  }
  // Both stones of a pair use up what is left.
  geometry.watch.quiet_until = geometry.watch.way + 0.5 * least;
  if (is_new) list_candidates(model, state, work, block, geometry);
}

}  // namespace trackbed
