// When pairs are due, and what their search starts from.
#include <algorithm>
#include <cmath>

#include "dem/inspect.h"
#include "dem/pair_blocks.h"
#include "dem/search.h"

namespace trackbed {
namespace {

using Index = std::size_t;

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
