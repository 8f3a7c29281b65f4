// Level two of the search for a stone and a wall: the stone's tree is walked against the wall's.
#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "dem/pair_motion.h"
#include "dem/search.h"

namespace trackbed {
namespace {

using Index = std::size_t;

/// The stone in the wall's frame: a wall may reach far, so that its own turning would be too large a bound.
Relative stone_seen_from_wall(const State& state, const WallPair& p) {
  const Index c = static_cast<Index>(p.clump);
  const Pose& wall = state.walls[static_cast<Index>(p.wall)].pose;
  return relative_pose(wall.position, wall.orientation, state.clumps.position[c],
                       state.clumps.orientation[c]);
}

double travel_of(const Workspace& work, const WallPair& p) {
  return work.travel[static_cast<Index>(p.clump)] + work.wall_travel[static_cast<Index>(p.wall)];
}

Skin skin_of(const Model& model, const State& state, const Workspace& work, const WallPair& p) {
  const Index w = static_cast<Index>(p.wall);
  const WallState& wall = state.walls[w];
  return skin_of(state, work,
                 speed_of(state, work, static_cast<Index>(p.clump)) + wall.velocity.norm() +
                     model.walls[w].shape.reach * wall.angular_velocity.norm());
}

/// Leaves out the candidates of a pair that stay too far from the wall until its bodies, which have moved by
/// `moved` since the search, have gone a little further.
void choose_tested(const Workspace& work, const WallPair& p, Index pair, double moved, double step,
                   WallGeometry& geometry) {
  step = std::min(step, geometry.search[pair].range - moved);
  geometry.due[pair] = travel_of(work, p) + step;
  geometry.tested[pair] = moved + step;
}

/// Measures the motion of the pairs that are due; whether one of them needs a new list.
bool must_search(const Model& model, const State& state, const Workspace& work, const WallBlock& block,
                 WallGeometry& geometry) {
  bool must = false;
  for (Index k = 0; k < block.pairs.size(); ++k) {
    const PairSearch& search = geometry.search[k];
    const WallPair& p = block.pairs[k];
    if (travel_of(work, p) <= geometry.due[k]) continue;
    const double moved =
        motion_since(search, stone_seen_from_wall(state, p), work.swing[static_cast<Index>(p.clump)]);
    if (search.range - moved > nearly_used_up * search.range)
      choose_tested(work, p, k, moved, skin_of(model, state, work, p).inner, geometry);
    else
      must = true;
  }
  return must;
}

/// Leaves the block alone until its stones and the walls may have used up what is left.
void rest(const Workspace& work, const WallBlock& block, WallGeometry& geometry) {
  double least = std::numeric_limits<double>::infinity();
  for (Index k = 0; k < block.pairs.size(); ++k)
    least = std::min(least, geometry.due[k] - travel_of(work, block.pairs[k]));
  geometry.watch.quiet_until = geometry.watch.way + least;
}

/// New lists of a block while it is searched.
struct Lists {
  std::vector<std::int32_t> keys;
  std::vector<WallMemory> memory;
  std::vector<WallCandidate> candidates;
  std::vector<int> facets;

  void clear() {
    keys.clear();
    memory.clear();
    candidates.clear();
    facets.clear();
  }
};

bool touches(const WallMemory& memory) {
  return std::any_of(memory.points.begin(), memory.points.end(),
                     [](const ContactMemory& m) { return m.touches(); });
}

/// Lists the pebbles of one clump with less than the skin to the wall, ascending. Those that touched in the
/// last step stay with their memory, however far they are now: their contacts have yet to be ended.
void append_candidates(const Model& model, const State& state, double skin, const WallBlock& block,
                       const WallPair& p, Lists& lists) {
  const Index c = static_cast<Index>(p.clump);
  const ClumpTemplate& stone = model.templates[static_cast<Index>(state.clumps.shape[c])];
  const WallShape& wall = model.walls[static_cast<Index>(p.wall)].shape;
  const double scale = state.clumps.scale[c];
  const Relative seen = stone_seen_from_wall(state, p);
  const auto place = [&](const Vec3& point) -> Vec3 { return seen.offset + seen.turn * (scale * point); };
  Index old = static_cast<Index>(p.first);
  const Index old_end = old + static_cast<Index>(p.count);

  const auto append = [&](std::int32_t pebble, const WallMemory& memory, int first_facet, double gap) {
    const Pebble& shape = stone.pebbles[static_cast<Index>(pebble)];
    lists.keys.push_back(pebble);
    lists.memory.push_back(memory);
    lists.candidates.push_back({scale * shape.centre, scale * shape.radius, gap, first_facet,
                                static_cast<int>(lists.facets.size()) - first_facet});
  };
  const auto keep_touching_before = [&](std::int32_t pebble) {
    for (; old < old_end && block.keys[old] < pebble; ++old)
      if (touches(block.memory[old]))
        append(block.keys[old], block.memory[old], static_cast<int>(lists.facets.size()), 0.0);
  };
  const auto is_near = [&](const Sphere& bound) {
    const Vec3 centre = place(bound.centre);
    const double radius = scale * bound.radius + skin;
    if (wall.is_plane) return centre.z() <= radius;
    const Sphere all = wall.tree.bound();
    return (all.centre - centre).squaredNorm() <= (all.radius + radius) * (all.radius + radius);
  };
  stone.tree.any(is_near, [&](int pebble) {
    const Pebble& shape = stone.pebbles[static_cast<Index>(pebble)];
    const Vec3 centre = place(shape.centre);
    const double radius = scale * shape.radius + skin;
    if (wall.is_plane && centre.z() > radius) return false;
    keep_touching_before(pebble);
    const Index first = lists.facets.size();
    double nearest2 = std::numeric_limits<double>::infinity();
    any_near_facet(wall, centre, radius, [&](int f, double distance2) {
      lists.facets.push_back(f);
      nearest2 = std::min(nearest2, distance2);
      return false;
    });
    if (!wall.is_plane && lists.facets.size() == first) return false;
    const WallMemory memory = old < old_end && block.keys[old] == pebble ? block.memory[old++] : WallMemory{};
    const double gap = (wall.is_plane ? centre.z() : std::sqrt(nearest2)) - scale * shape.radius;
    append(pebble, memory, static_cast<int>(first), touches(memory) ? std::min(gap, 0.0) : gap);
    return false;
  });
  keep_touching_before(static_cast<std::int32_t>(stone.pebbles.size()));
}

}  // namespace

void refresh(const Model& model, const State& state, const Workspace& work, WallBlock& block,
             WallGeometry& geometry) {
  // If one pair needs a new list, the whole small block gets one.
  if (!must_search(model, state, work, block, geometry)) {
    rest(work, block, geometry);
    return;
  }
  thread_local Lists lists;
  lists.clear();
  for (Index k = 0; k < block.pairs.size(); ++k) {
    WallPair& p = block.pairs[k];
    const int first = static_cast<int>(lists.keys.size());
    const Skin skin = skin_of(model, state, work, p);
    append_candidates(model, state, skin.outer, block, p, lists);
    p.first = first;
    p.count = static_cast<int>(lists.keys.size()) - first;
    const Relative seen = stone_seen_from_wall(state, p);
    geometry.search[k] = {seen.turn, seen.offset, skin.outer};
    choose_tested(work, p, k, 0.0, skin.inner, geometry);
  }
  block.keys = lists.keys;
  block.memory = lists.memory;
  geometry.candidates = lists.candidates;
  geometry.facets = lists.facets;
  rest(work, block, geometry);
}

}  // namespace trackbed
