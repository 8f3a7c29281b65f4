// Walks over the contacts that touch, for everything that is not done at every step: time step, measures,
// output.
#pragma once

#include <algorithm>
#include <vector>

#include "base/runs.h"
#include "dem/laws/table.h"
#include "dem/model.h"
#include "dem/state.h"

namespace trackbed {

/// One touching contact, as it stands after a step. Body 1 is always a stone.
struct Touching {
  int clump_1;            // index of the stone
  int clump_2;            // index of the other stone, or -1
  int wall;               // index of the wall, or -1
  int pebble_1;           // place in the template
  Vec3 normal;            // from 1 to 2
  double overlap;         // [m]
  Vec3 point;             // middle of the overlap [m]
  Vec3 lever_1, lever_2;  // from the centre of mass, or the wall's origin, to the point [m]
  double radius;          // effective [m]
  double reduced_mass;    // m1 m2/(m1 + m2); the stone's against a wall without mass [kg]
  const ContactProperties* properties;
  const ContactMemory* memory;

  /// Elastic force on body 2 [N].
  Vec3 force() const { return properties->kn * overlap * normal + memory->shear; }
};

/// The smaller of what a size says of the two stones; that of the one stone where it touches a wall.
template <class Size>
double smaller_of_stones(const Touching& t, Size&& size) {
  const double size_1 = size(static_cast<std::size_t>(t.clump_1));
  return t.clump_2 < 0 ? size_1 : std::min(size_1, size(static_cast<std::size_t>(t.clump_2)));
}

/// The touching contacts of one clump pair, or of one clump and a wall.
template <class Visit>
void visit_pair(const Model& model, const State& state, const PairBlock& block, const ClumpPair& pair,
                Visit&& visit) {
  const Clumps& c = state.clumps;
  const auto i = static_cast<std::size_t>(pair.i), j = static_cast<std::size_t>(pair.j);
  const ClumpTemplate& ti = model.templates[static_cast<std::size_t>(c.shape[i])];
  const ClumpTemplate& tj = model.templates[static_cast<std::size_t>(c.shape[j])];
  for (int k = pair.first; k < pair.first + pair.count; ++k) {
    const ContactMemory& m = block.memory[static_cast<std::size_t>(k)];
    if (!m.touches()) continue;
    const PebblePair key = block.keys[static_cast<std::size_t>(k)];
    const Pebble& pebble = ti.pebbles[static_cast<std::size_t>(key.a)];
    const double r1 = c.scale[i] * pebble.radius;
    const double r2 = c.scale[j] * tj.pebbles[static_cast<std::size_t>(key.b)].radius;
    Touching t;
    t.clump_1 = pair.i;
    t.clump_2 = pair.j;
    t.wall = -1;
    t.pebble_1 = key.a;
    t.normal = m.normal;
    t.overlap = m.overlap;
    t.lever_1 = c.orientation[i] * (c.scale[i] * pebble.centre) + (r1 - 0.5 * m.overlap) * m.normal;
    t.lever_2 = t.lever_1 - (c.position[j] - c.position[i]);
    t.point = c.position[i] + t.lever_1;
    t.radius = r1 * r2 / (r1 + r2);
    t.reduced_mass = c.mass[i] * c.mass[j] / (c.mass[i] + c.mass[j]);
    t.properties = &model.pairs(c.material[i], c.material[j]);
    t.memory = &m;
    visit(t);
  }
}

template <class Visit>
void visit_pair(const Model& model, const State& state, const WallBlock& block, const WallPair& pair,
                Visit&& visit) {
  const Clumps& c = state.clumps;
  const auto i = static_cast<std::size_t>(pair.clump), w = static_cast<std::size_t>(pair.wall);
  const ClumpTemplate& shape = model.templates[static_cast<std::size_t>(c.shape[i])];
  for (int k = pair.first; k < pair.first + pair.count; ++k) {
    for (const ContactMemory& m : block.memory[static_cast<std::size_t>(k)].points) {
      if (!m.touches()) continue;
      Touching t;
      t.pebble_1 = block.keys[static_cast<std::size_t>(k)];
      const Pebble& pebble = shape.pebbles[static_cast<std::size_t>(t.pebble_1)];
      t.radius = c.scale[i] * pebble.radius;
      t.clump_1 = pair.clump;
      t.clump_2 = -1;
      t.wall = pair.wall;
      t.normal = m.normal;
      t.overlap = m.overlap;
      t.lever_1 = c.orientation[i] * (c.scale[i] * pebble.centre) + (t.radius - 0.5 * m.overlap) * m.normal;
      t.lever_2 = t.lever_1 - (state.walls[w].pose.position - c.position[i]);
      t.point = c.position[i] + t.lever_1;
      t.reduced_mass = c.mass[i];
      if (const auto& body = model.walls[w].body) t.reduced_mass *= body->mass / (body->mass + c.mass[i]);
      t.properties = &model.pairs(c.material[i], model.walls[w].material);
      t.memory = &m;
      visit(t);
    }
  }
}

/// The touching contacts of one wall.
template <class Visit>
void visit_wall(const Model& model, const State& state, int wall, Visit&& visit) {
  for (const WallBlock& block : state.wall_blocks) {
    if (block.pairs.back().wall < wall) continue;
    if (block.pairs.front().wall > wall) break;
    for (const WallPair& pair : block.pairs)
      if (pair.wall == wall) visit_pair(model, state, block, pair, visit);
  }
}

/// All touching contacts: stone pairs first, then walls, in the order of their indices.
template <class Visit>
void visit_touching(const Model& model, const State& state, Visit&& visit) {
  for (const PairBlock& block : state.pair_blocks)
    for (const ClumpPair& pair : block.pairs) visit_pair(model, state, block, pair, visit);
  for (const WallBlock& block : state.wall_blocks)
    for (const WallPair& pair : block.pairs) visit_pair(model, state, block, pair, visit);
}

/// Blocks of pairs that one thread takes at a time, at least.
constexpr std::size_t blocks_in_run = 4;

/// The sum of what `add(sum, t)` adds for each touching contact t, by all threads; the same bits for any
/// number of them.
template <class Sum, class Add>
Sum sum_of_touching(const Model& model, const State& state, Add&& add) {
  const auto of_blocks = [&](const auto& blocks) {
    const auto add_block = [&](Sum& sum, std::size_t b) {
      for (const auto& pair : blocks[b].pairs)
        visit_pair(model, state, blocks[b], pair, [&](const Touching& t) { add(sum, t); });
    };
    return sum_by_runs<Sum>(blocks.size(), add_block, blocks_in_run);
  };
  Sum sum = of_blocks(state.pair_blocks);
  sum += of_blocks(state.wall_blocks);
  return sum;
}

}  // namespace trackbed
