// Level two of the search for two stones: their two trees are walked against each other.
#include <algorithm>
#include <cmath>
#include <utility>

#include "dem/pair_motion.h"
#include "dem/search.h"

namespace trackbed {
namespace {

using Index = std::size_t;

struct Found {
  PebblePair key;
  Vec3 a, b;
  double radius_a, radius_b;
};

/// Per-thread memory of a search, kept from call to call so that a step allocates nothing.
struct Scratch {
  std::vector<Found> found;
  std::vector<std::pair<int, int>> stack;
  std::vector<double> columns;
  std::vector<PebblePair> keys;
  std::vector<ContactMemory> memory;
};

Scratch& scratch() {
  thread_local Scratch memory;
  return memory;
}

bool is_before(const PebblePair& x, const PebblePair& y) {
  return x.a != y.a ? x.a < y.a : x.b < y.b;
}

/// Pebble pairs of two clumps with less than the skin between them, in the order of the walk.
void find_candidates(const ClumpTemplate& ti, double si, const ClumpTemplate& tj, double sj,
                     const Relative& pose, double skin, Scratch& s) {
  s.found.clear();
  s.stack.assign(1, {0, 0});
  const Mat3 turn = pose.turn.toRotationMatrix();
  while (!s.stack.empty()) {
    const auto [a, b] = s.stack.back();
    s.stack.pop_back();
    const SphereTree::Node& na = ti.tree.nodes[static_cast<Index>(a)];
    const SphereTree::Node& nb = tj.tree.nodes[static_cast<Index>(b)];
    const Vec3 cb = pose.offset + sj * (turn * nb.bound.centre);
    const double near = si * na.bound.radius + sj * nb.bound.radius + skin;
    if ((cb - si * na.bound.centre).squaredNorm() > near * near) continue;
    if (na.is_leaf() && nb.is_leaf()) {
      for (int l = nb.first; l < nb.first + nb.count; ++l) {
        const Pebble& pb = tj.pebbles[static_cast<Index>(l)];
        const Vec3 local_b = sj * pb.centre;
        const Vec3 xb = pose.offset + turn * local_b;
        for (int k = na.first; k < na.first + na.count; ++k) {
          const Pebble& pa = ti.pebbles[static_cast<Index>(k)];
          const double reach = si * pa.radius + sj * pb.radius + skin;
          const Vec3 xa = si * pa.centre;
          if ((xb - xa).squaredNorm() <= reach * reach)
            s.found.push_back({{k, l}, xa, local_b, si * pa.radius, sj * pb.radius});
        }
      }
    } else if (nb.is_leaf() || (!na.is_leaf() && si * na.bound.radius >= sj * nb.bound.radius)) {
      s.stack.emplace_back(na.right, b);
      s.stack.emplace_back(a + 1, b);
    } else {
      s.stack.emplace_back(a, nb.right);
      s.stack.emplace_back(a, b + 1);
    }
  }
}

/// Adds the candidates that touched in the last step, however far they are now: their contacts have yet to be
/// ended, and their energy booked. Sorts all by key.
void keep_touching(const PairBlock& block, const ClumpPair& p, const Model& model, const Clumps& c,
                   Scratch& s) {
  const Index i = static_cast<Index>(p.i), j = static_cast<Index>(p.j);
  for (Index k = static_cast<Index>(p.first); k < static_cast<Index>(p.first + p.count); ++k) {
    if (!block.memory[k].touches()) continue;
    const PebblePair key = block.keys[k];
    const Pebble& a = model.templates[static_cast<Index>(c.shape[i])].pebbles[static_cast<Index>(key.a)];
    const Pebble& b = model.templates[static_cast<Index>(c.shape[j])].pebbles[static_cast<Index>(key.b)];
    s.found.push_back(
        {key, c.scale[i] * a.centre, c.scale[j] * b.centre, c.scale[i] * a.radius, c.scale[j] * b.radius});
  }
  std::sort(s.found.begin(), s.found.end(),
            [](const Found& x, const Found& y) { return is_before(x.key, y.key); });
  const auto same = [](const Found& x, const Found& y) { return x.key.a == y.key.a && x.key.b == y.key.b; };
  s.found.erase(std::unique(s.found.begin(), s.found.end(), same), s.found.end());
}

/// Puts the found candidates in the place of the pair's old ones; touching contacts keep their memory.
void replace_candidates(Index pair, Scratch& s, PairBlock& block, PairGeometry& geometry) {
  ClumpPair& p = block.pairs[pair];
  const Index n = s.found.size();
  s.keys.resize(n);
  s.memory.assign(n, {});
  s.columns.resize(n * PairGeometry::columns);
  Index old = static_cast<Index>(p.first);
  const Index old_end = old + static_cast<Index>(p.count);
  for (Index k = 0; k < n; ++k) {
    const Found& f = s.found[k];
    s.keys[k] = f.key;
    while (old < old_end && is_before(block.keys[old], f.key)) ++old;
    if (old < old_end && !is_before(f.key, block.keys[old])) s.memory[k] = block.memory[old];
    const double column[PairGeometry::columns] = {
        f.a.x(), f.a.y(), f.a.z(), f.b.x(), f.b.y(), f.b.z(), f.radius_a + f.radius_b, f.radius_a};
    for (Index c = 0; c < PairGeometry::columns; ++c) s.columns[c * n + k] = column[c];
  }
  const auto splice = [&](auto& into, const auto& from, Index width) {
    const auto first = into.begin() + static_cast<std::ptrdiff_t>(static_cast<Index>(p.first) * width);
    const auto common = static_cast<std::ptrdiff_t>(std::min(n, static_cast<Index>(p.count)) * width);
    std::copy(from.begin(), from.begin() + common, first);
    if (n > static_cast<Index>(p.count))
      into.insert(first + common, from.begin() + common, from.end());
    else
      into.erase(first + common, first + static_cast<std::ptrdiff_t>(static_cast<Index>(p.count) * width));
  };
  splice(block.keys, s.keys, 1);
  splice(block.memory, s.memory, 1);
  splice(geometry.columns_of_pairs, s.columns, PairGeometry::columns);
  const int more = static_cast<int>(n) - p.count;
  p.count = static_cast<int>(n);
  for (Index later = pair + 1; later < block.pairs.size(); ++later) block.pairs[later].first += more;
}

}  // namespace

void refresh(const Model& model, const State& state, const Workspace& work, PairBlock& block,
             PairGeometry& geometry) {
  for (Index k = 0; k < block.pairs.size(); ++k) {
    PairSearch& search = geometry.search[k];
    const Index i = static_cast<Index>(block.pairs[k].i), j = static_cast<Index>(block.pairs[k].j);
    const double travel = work.travel[i] + work.travel[j];
    if (travel <= search.due) continue;

    const Relative now = relative_pose(state.clumps.position[i], state.clumps.orientation[i],
                                       state.clumps.position[j], state.clumps.orientation[j]);
    const double left = search.range - motion_since(search, now, work.bound[j]);
    if (left > nearly_used_up * work.skin) {
      search.due = travel + left;
      continue;
    }
    const double apart = now.offset.norm() - work.bound[i] - work.bound[j];
    if (apart > work.skin) {
      // Too far to touch before they have come nearer by that much.
      if (block.pairs[k].count > 0) {
        scratch().found.clear();
        keep_touching(block, block.pairs[k], model, state.clumps, scratch());
        replace_candidates(k, scratch(), block, geometry);
      }
      search = {now.offset, now.turn, apart, travel + apart};
      continue;
    }
    const Clumps& c = state.clumps;
    find_candidates(model.templates[static_cast<Index>(c.shape[i])], c.scale[i],
                    model.templates[static_cast<Index>(c.shape[j])], c.scale[j], now, work.skin, scratch());
    keep_touching(block, block.pairs[k], model, c, scratch());
    replace_candidates(k, scratch(), block, geometry);
    search = {now.offset, now.turn, work.skin, travel + work.skin};
  }
}

}  // namespace trackbed
