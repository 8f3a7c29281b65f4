// Contacts between stones, and the sums of all forces.
#include "dem/forces.h"

#include <algorithm>

#include "dem/open_contact.h"
#include "dem/search.h"
#include "dem/touch.h"

namespace trackbed {
namespace {

using Index = std::size_t;

void frame_pair(const StoneMotion& i, const StoneMotion& j, const ContactProperties& p, PairFrame& f) {
  Row shift = j.position - i.position;
  shift.pack[3] = 0;
  f.shift = shift;
  f.spin = j.spin - i.spin;
  f.mean_spin = Lanes(0.5) * (i.spin + j.spin);
  Row velocity = j.velocity - i.velocity - cross(j.spin, shift);
  if (p.dashpot.normal > 0 || p.dashpot.shear > 0) {
    const double mi = i.velocity[3], mj = j.velocity[3];
    velocity.pack[3] = mi * mj / (mi + mj);
  }
  f.velocity = velocity;
  f.properties = &p;
}

/// Motion of a contact that opens, at the place where its pebbles are nearest.
ContactKinematics opening_of(const PairFrame& f, const Touch& t, double dt) {
  const Vec3 between = xyz(t.between);
  const double distance = between.norm(), reach = t.between[3], radius_1 = t.centre[3];
  const Vec3 lever = xyz(t.centre) + (radius_1 - 0.5 * (reach - distance)) / distance * between;
  ContactKinematics k;
  k.spin = xyz(f.spin);
  k.velocity = xyz(f.velocity) + k.spin.cross(lever);
  k.radius = radius_1 * (reach - radius_1) / reach;
  k.dt = dt;
  return k;
}

/// A stone of a pair: its motion, and its pebbles at scale 1.
struct Stone {
  const StoneMotion& motion;
  const Pebble* pebbles;

  /// Centre of a pebble from the stone's, world axes, and its radius.
  Row place(std::int32_t pebble) const {
    const Pebble& p = pebbles[pebble];
    const double scale = motion.position[3];
    const Vec3 centre = scale * p.centre;
    Row out = motion.axes[0] * centre.x() + motion.axes[1] * centre.y() + motion.axes[2] * centre.z();
    out.pack[3] = scale * p.radius;
    return out;
  }
};

/// Adds the touching candidates of a pair to `s`, and ends the contacts that have opened.
void find_touches(const ClumpPair& pair, const Stone& i, const Stone& j, double dt, PairBlock& block,
                  Touches& s, Losses& losses) {
  const PairFrame& f = s.frames.back();
  const int frame = static_cast<int>(s.frames.size()) - 1;
  s.touches.reserve(static_cast<Index>(pair.count));
  for (Index k = static_cast<Index>(pair.first); k < static_cast<Index>(pair.first + pair.count); ++k) {
    const PebblePair key = block.keys[k];
    const Row centre = i.place(key.a), other = j.place(key.b);
    const double reach = centre[3] + other[3];
    Row between = f.shift + other - centre;
    const Row squares = between * between;
    const double distance2 = squares[0] + squares[1] + squares[2];
    between.pack[3] = reach;
    Touch& t = s.touches.add();
    t.between = between;
    t.centre = centre;
    t.frame = frame;
    t.memory = &block.memory[k];
    // Which candidates touch cannot be foretold: no jump hangs on it, but on the rare one that opens.
    const bool is_apart = !(distance2 < reach * reach);
    if (is_apart & t.memory->touches()) open_contact(*f.properties, opening_of(f, t, dt), *t.memory, losses);
    s.touches.drop(is_apart);
  }
}

/// Sums the touches of a pair, which begin at `next`.
TouchSum sum_touches(const Touches& s, int frame, Index& next) {
  TouchSum sum;
  for (; next < s.touches.size() && s.touches[next].frame == frame; ++next) sum += s.touches[next];
  return sum;
}

/// What clump j receives.
PairResult result_for_second(const TouchSum& sum, const PairFrame& frame) {
  PairResult r{sum.force, sum.moment - cross(frame.shift, sum.force)};
  r.force.pack[3] = 0;
  r.moment.pack[3] = 0;
  return r;
}

/// Asks for the memory of a block that comes soon: it lies where no pattern leads the processor.
void prefetch(const PairBlock& block) {
  constexpr Index line = 64;
  const auto lines = [](const auto& values) {
    const char* at = reinterpret_cast<const char*>(values.data());
    for (Index k = 0; k < values.size() * sizeof(values[0]); k += line) __builtin_prefetch(at + k, 1);
  };
  lines(block.pairs);
  lines(block.keys);
  lines(block.memory);
}

/// Pairs without candidates give nothing from now on.
void clear_results(const PairBlock& block, Index first_pair, Workspace& work) {
  for (Index k = 0; k < block.pairs.size(); ++k) {
    const int result = work.result_of_pair[first_pair + k];
    if (block.pairs[k].count == 0 && result >= 0) work.pair_results[static_cast<Index>(result)] = {0.0, 0.0};
  }
}

/// Gives the touches of a block, which have responded, to its stones.
void hand_out(const PairBlock& block, const std::vector<int>& active, Index first_pair, const Touches& s,
              Workspace& work) {
  Index next = 0;
  int frame = 0;
  for (const int k : active) {
    const ClumpPair& pair = block.pairs[static_cast<Index>(k)];
    const int result = work.result_of_pair[first_pair + static_cast<Index>(k)];
    const TouchSum sum = sum_touches(s, frame, next);
    const PairResult second = result_for_second(sum, s.frames[static_cast<Index>(frame++)]);
    PatchSum& i = work.patch_sums[static_cast<Index>(pair.i)];
    i.force -= sum.force;
    i.moment -= sum.moment;
    work.dashpot_losses[static_cast<Index>(pair.i)] += sum.dashpot;
    if (result >= 0) {
      work.pair_results[static_cast<Index>(result)] = second;
    } else {
      PatchSum& j = work.patch_sums[static_cast<Index>(pair.j)];
      j.force += second.force;
      j.moment += second.moment;
    }
  }
}

int block_forces(const Model& model, State& state, Workspace& work, Index b, double dt) {
  thread_local Touches s;
  PairBlock& block = state.pair_blocks[b];
  if (b + 1 < state.pair_blocks.size()) prefetch(state.pair_blocks[b + 1]);
  PairGeometry& geometry = work.pair_geometry[b];
  const Index first_pair = static_cast<Index>(work.first_pair_of_block[b]);
  if (work.way >= geometry.quiet_until) {
    refresh(model, state, work, block, geometry);
    clear_results(block, first_pair, work);
  }
  const Clumps& c = state.clumps;
  s.clear();
  s.frames.reserve(block.pairs.size());
  for (const int k : geometry.active) {
    const ClumpPair& pair = block.pairs[static_cast<Index>(k)];
    const Index i = static_cast<Index>(pair.i), j = static_cast<Index>(pair.j);
    const Stone one{work.motion[i], model.templates[static_cast<Index>(c.shape[i])].pebbles.data()};
    const Stone two{work.motion[j], model.templates[static_cast<Index>(c.shape[j])].pebbles.data()};
    frame_pair(one.motion, two.motion, model.pairs(c.material[i], c.material[j]), s.frames.add());
    Losses losses;
    find_touches(pair, one, two, dt, block, s, losses);
    PatchSum& sum = work.patch_sums[i];
    sum.force.pack[3] -= losses.friction;
    sum.moment.pack[3] -= losses.rolling;
  }
  respond<TouchKind::between_pebbles>(s, dt);
  hand_out(block, geometry.active, first_pair, s, work);
  return static_cast<int>(s.touches.size());
}

int patch_forces(const Model& model, State& state, Workspace& work, Index patch, double dt) {
  const Index size = static_cast<Index>(work.patch_size);
  const Index last = std::min((patch + 1) * size, work.patch_sums.size());
  for (Index c = patch * size; c < last; ++c) {
    work.patch_sums[c] = {};
    work.dashpot_losses[c] = 0;
  }
  int touching = 0;
  for (int b = work.first_block_of_patch[patch]; b < work.first_block_of_patch[patch + 1]; ++b)
    touching += block_forces(model, state, work, static_cast<Index>(b), dt);
  return touching;
}

void gather_clump(State& state, const Workspace& work, Index c) {
  Row force = work.patch_sums[c].force, moment = work.patch_sums[c].moment;
  StoneLosses& losses = state.clumps.losses[c];
  losses.friction -= force[3];
  losses.rolling -= moment[3];
  losses.dashpot += work.dashpot_losses[c];
  for (int e = work.first_result[c]; e < work.first_result[c + 1]; ++e) {
    const PairResult& r = work.pair_results[static_cast<Index>(work.results[static_cast<Index>(e)])];
    force += r.force;
    moment += r.moment;
  }
  Vec3 f = xyz(force), m = xyz(moment);
  for (int e = work.first_wall_entry[c]; e < work.first_wall_entry[c + 1]; ++e) {
    const WallResult& r = work.wall_results[static_cast<Index>(work.wall_entries[static_cast<Index>(e)])];
    f -= r.force;
    m += r.moment_clump;
    losses += r.losses;
  }
  state.clumps.force[c] = f;
  state.clumps.moment[c] = m;
}

void gather_wall(const Model& model, State& state, const Workspace& work, Index w, double dt) {
  WallState& wall = state.walls[w];
  Vec3 force = Vec3::Zero(), moment = Vec3::Zero();
  for (int p = work.first_pair_of_wall[w]; p < work.first_pair_of_wall[w + 1]; ++p) {
    force += work.wall_results[static_cast<Index>(p)].force;
    moment += work.wall_results[static_cast<Index>(p)].moment_wall;
  }
  // Work done on the stones by a wall that is moved, with the mean of the reactions before and after the
  // step.
  if (!model.walls[w].body)
    wall.boundary_work -=
        0.5 * dt *
        ((wall.force + force).dot(wall.velocity) + (wall.moment + moment).dot(wall.angular_velocity));
  wall.force = force;
  wall.moment = moment;
}

}  // namespace

void contact_forces(const Model& model, State& state, Workspace& work, double dt) {
  const int n = static_cast<int>(work.first_block_of_patch.size()) - 1;
  const int n_all = n + static_cast<int>(state.wall_blocks.size());
  int touching = 0;
#pragma omp parallel for schedule(dynamic, 1) reduction(+ : touching) if (n_all > 8)
  for (int k = 0; k < n_all; ++k)
    touching += k < n ? patch_forces(model, state, work, static_cast<Index>(k), dt)
                      : wall_block_forces(model, state, work, static_cast<Index>(k - n), dt);
  work.touching = touching;
}

void gather_forces(const Model& model, State& state, Workspace& work, double dt) {
#pragma omp parallel for schedule(static) if (state.clumps.size() > 64)
  for (int c = 0; c < state.clumps.size(); ++c) gather_clump(state, work, static_cast<Index>(c));
  for (Index w = 0; w < state.walls.size(); ++w) gather_wall(model, state, work, w, dt);
}

}  // namespace trackbed
