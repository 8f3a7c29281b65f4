// Level two of the search: the candidates of one pair, by walking the two trees against each other.
#include <algorithm>
#include <cmath>
#include <utility>

#include "dem/search.h"

namespace trackbed {
namespace {

using Index = std::size_t;

// A pair is looked through again when less than this share of its skin is left, rather than measured each
// step.
constexpr double nearly_used_up = 0.25;

/// Pose of one body in the frame of another.
struct Relative {
  Vec3 offset;
  Quat turn;
};

Relative relative_pose(const Vec3& x1, const Quat& q1, const Vec3& x2, const Quat& q2) {
  const Quat back = q1.conjugate();
  return {back * (x2 - x1), back * q2};
}

/// Bound on how far any point within `reach` of body 2 has moved in the frame of body 1 since the search.
double motion_since(const PairSearch& search, const Relative& now, double reach) {
  const Quat turned = search.turn.conjugate() * now.turn;
  return (now.offset - search.offset).norm() + 2.0 * reach * turned.vec().norm();
}

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
  std::vector<WallCandidate> wall_candidates;
  std::vector<int> facets;
  std::vector<std::int32_t> wall_keys;
  std::vector<WallMemory> wall_memory;
  std::vector<std::pair<std::int32_t, int>> touched;
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

/// Facets whose distance to the sphere is below its radius, in ascending order, behind those in `facets`.
void append_near_facets(const WallShape& shape, const Vec3& centre, double radius, Scratch& s) {
  s.stack.assign(1, {0, 0});
  const Index first = s.facets.size();
  while (!s.stack.empty()) {
    const int k = s.stack.back().first;
    s.stack.pop_back();
    const SphereTree::Node& node = shape.tree.nodes[static_cast<Index>(k)];
    const double near = node.bound.radius + radius;
    if ((node.bound.centre - centre).squaredNorm() > near * near) continue;
    if (!node.is_leaf()) {
      s.stack.emplace_back(node.right, 0);
      s.stack.emplace_back(k + 1, 0);
      continue;
    }
    for (int f = node.first; f < node.first + node.count; ++f) {
      const Vec3 q = closest_point(shape.facets[static_cast<Index>(f)], centre);
      if ((q - centre).squaredNorm() <= radius * radius) s.facets.push_back(f);
    }
  }
  std::sort(s.facets.begin() + static_cast<std::ptrdiff_t>(first), s.facets.end());
}

/// Pebbles of a clump with less than the skin to the wall. `wall` is the wall's pose in the clump's frame.
void find_wall_candidates(const ClumpTemplate& shape, double scale, const WallShape& wall,
                          const Relative& pose, double skin, Scratch& s) {
  s.wall_candidates.clear();
  s.wall_keys.clear();
  s.facets.clear();
  // Place of the clump in the wall's frame.
  const Quat turn = pose.turn.conjugate();
  const Vec3 offset = turn * -pose.offset;
  s.touched.assign(1, {0, 0});
  std::vector<std::int32_t>& pebbles = s.wall_keys;
  while (!s.touched.empty()) {
    const int k = s.touched.back().first;
    s.touched.pop_back();
    const SphereTree::Node& node = shape.tree.nodes[static_cast<Index>(k)];
    const Vec3 centre = offset + turn * (scale * node.bound.centre);
    const double radius = scale * node.bound.radius + skin;
    if (wall.is_plane) {
      if (centre.z() > radius) continue;
    } else {
      const SphereTree::Node& root = wall.tree.nodes[0];
      const double near = root.bound.radius + radius;
      if ((root.bound.centre - centre).squaredNorm() > near * near) continue;
    }
    if (!node.is_leaf()) {
      s.touched.emplace_back(node.right, 0);
      s.touched.emplace_back(k + 1, 0);
      continue;
    }
    for (int p = node.first; p < node.first + node.count; ++p) {
      const Pebble& pebble = shape.pebbles[static_cast<Index>(p)];
      const Vec3 local = scale * pebble.centre;
      const Vec3 x = offset + turn * local;
      const double reach = scale * pebble.radius + skin;
      const int first = static_cast<int>(s.facets.size());
      if (wall.is_plane) {
        if (x.z() > reach) continue;
      } else {
        append_near_facets(wall, x, reach, s);
        if (static_cast<int>(s.facets.size()) == first) continue;
      }
      pebbles.push_back(p);
      s.wall_candidates.push_back(
          {local, scale * pebble.radius, first, static_cast<int>(s.facets.size()) - first});
    }
  }
  // The walk visits leaves, and so pebbles, in ascending order: right children were pushed first.
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

void refresh(const Model& model, const State& state, const Workspace& work, WallBlock& block,
             WallGeometry& geometry) {
  bool is_due = false;
  for (Index k = 0; k < block.pairs.size() && !is_due; ++k)
    is_due = work.travel[static_cast<Index>(block.pairs[k].clump)] +
                 work.wall_travel[static_cast<Index>(block.pairs[k].wall)] >
             geometry.search[k].due;
  if (!is_due) return;

  // One or more pairs must be looked at; if any needs a new list, the whole small block gets one.
  bool must_search = false;
  for (Index k = 0; k < block.pairs.size(); ++k) {
    PairSearch& search = geometry.search[k];
    const Index c = static_cast<Index>(block.pairs[k].clump), w = static_cast<Index>(block.pairs[k].wall);
    const double travel = work.travel[c] + work.wall_travel[w];
    if (travel <= search.due) continue;
    const WallState& wall = state.walls[w];
    const Relative now = relative_pose(state.clumps.position[c], state.clumps.orientation[c],
                                       wall.pose.position, wall.pose.orientation);
    // A wall may reach far: measure the clump's motion in the wall's frame instead.
    const Relative seen{now.turn.conjugate() * -now.offset, now.turn.conjugate()};
    const Relative then{search.turn.conjugate() * -search.offset, search.turn.conjugate()};
    const PairSearch before{then.offset, then.turn, search.range, search.due};
    const double left = search.range - motion_since(before, seen, work.bound[c]);
    if (left > nearly_used_up * work.skin)
      search.due = travel + left;
    else
      must_search = true;
  }
  if (!must_search) return;

  Scratch& s = scratch();
  std::vector<WallCandidate> candidates;
  std::vector<int> facets;
  std::vector<std::int32_t> keys;
  std::vector<WallMemory> memory;
  for (Index k = 0; k < block.pairs.size(); ++k) {
    WallPair& p = block.pairs[k];
    const Index c = static_cast<Index>(p.clump), w = static_cast<Index>(p.wall);
    const WallState& wall = state.walls[w];
    const Relative now = relative_pose(state.clumps.position[c], state.clumps.orientation[c],
                                       wall.pose.position, wall.pose.orientation);
    find_wall_candidates(model.templates[static_cast<Index>(state.clumps.shape[c])], state.clumps.scale[c],
                         model.walls[w].shape, now, work.skin, s);
    geometry.search[k] = {now.offset, now.turn, work.skin, work.travel[c] + work.wall_travel[w] + work.skin};

    Index old = static_cast<Index>(p.first);
    const Index old_end = old + static_cast<Index>(p.count);
    p.first = static_cast<int>(keys.size());
    // A pebble that touched in the last step stays, however far it is now: its contact has yet to be ended.
    const auto keep_touching = [&] {
      const WallMemory& kept = block.memory[old];
      const auto touches = [](const ContactMemory& m) { return m.touches(); };
      if (std::any_of(kept.points.begin(), kept.points.end(), touches)) {
        const Index shape = static_cast<Index>(state.clumps.shape[c]);
        const Pebble& pebble = model.templates[shape].pebbles[static_cast<Index>(block.keys[old])];
        const double scale = state.clumps.scale[c];
        memory.push_back(kept);
        keys.push_back(block.keys[old]);
        candidates.push_back({scale * pebble.centre, scale * pebble.radius, 0, 0});
      }
      ++old;
    };
    for (Index m = 0; m < s.wall_keys.size(); ++m) {
      while (old < old_end && block.keys[old] < s.wall_keys[m]) keep_touching();
      const bool is_known = old < old_end && block.keys[old] == s.wall_keys[m];
      memory.push_back(is_known ? block.memory[old++] : WallMemory{});
      keys.push_back(s.wall_keys[m]);
      WallCandidate candidate = s.wall_candidates[m];
      candidate.first_facet += static_cast<int>(facets.size());
      candidates.push_back(candidate);
    }
    while (old < old_end) keep_touching();
    p.count = static_cast<int>(keys.size()) - p.first;
    facets.insert(facets.end(), s.facets.begin(), s.facets.end());
  }
  block.keys = std::move(keys);
  block.memory = std::move(memory);
  geometry.candidates = std::move(candidates);
  geometry.facets = std::move(facets);
}

}  // namespace trackbed
