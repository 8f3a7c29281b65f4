// Contacts between stones, and the sums of all forces.
#include "dem/forces.h"

#include <algorithm>

#include "dem/open_contact.h"
#include "dem/search.h"
#include "dem/touch.h"

namespace trackbed {
namespace {

using Index = std::size_t;

Row rotated(const std::array<Row, 3>& axes, const Vec3& v) {
  return axes[0] * v.x() + axes[1] * v.y() + axes[2] * v.z();
}

PairFrame frame_of(const StoneMotion& i, const StoneMotion& j, const ContactProperties& p) {
  PairFrame f;
  f.shift = j.position - i.position;
  f.spin = j.spin - i.spin;
  f.mean_spin = Lanes(0.5) * (i.spin + j.spin);
  f.velocity = j.velocity - i.velocity - cross(j.spin, f.shift);
  f.properties = &p;
  if (p.dashpot.normal > 0 || p.dashpot.shear > 0) {
    const double mi = i.velocity[3], mj = j.velocity[3];
    f.velocity.pack[3] = mi * mj / (mi + mj);
  }
  return f;
}

/// Motion of a contact that opens, at the place where its pebbles are nearest.
ContactKinematics opening_of(const PairFrame& f, const PairCandidate& c, const Touch& t, double dt) {
  const Vec3 between = xyz(t.between);
  const double distance = between.norm();
  const Vec3 lever = xyz(t.centre) + (c.radius_a - 0.5 * (c.reach - distance)) / distance * between;
  ContactKinematics k;
  k.spin = xyz(f.spin);
  k.velocity = xyz(f.velocity) + k.spin.cross(lever);
  k.radius = c.radius_a * (c.reach - c.radius_a) / c.reach;
  k.dt = dt;
  return k;
}

/// Adds the touching candidates of a pair to `touches`, and ends the contacts that have opened.
void find_touches(const ClumpPair& pair, const StoneMotion& i, const StoneMotion& j,
                  const PairGeometry& geometry, double dt, PairBlock& block, Touches& s, Losses& losses) {
  const PairFrame& f = s.frames.back();
  for (Index k = static_cast<Index>(pair.first); k < static_cast<Index>(pair.first + pair.count); ++k) {
    const PairCandidate& c = geometry.candidates[k];
    const Row centre = rotated(i.axes, c.a);
    Row between = f.shift + rotated(j.axes, c.b) - centre;
    const Row squares = between * between;
    Touch t;
    t.between = between;
    t.centre = centre;
    ContactMemory& memory = block.memory[k];
    if (squares[0] + squares[1] + squares[2] < c.reach * c.reach) {
      t.between.pack[3] = c.reach;
      t.centre.pack[3] = c.radius_a;
      t.frame = static_cast<int>(s.frames.size()) - 1;
      t.memory = &memory;
      s.touches.push_back(t);
    } else if (memory.touches()) {
      open_contact(*f.properties, opening_of(f, c, t, dt), memory, losses);
    }
  }
}

/// Sums the touches of pair `p`, which begin at `next`, for its two stones.
void sum_touches(const Touches& s, int frame, Index& next, PairResult& result, int& contacts, OwnSum& own) {
  TouchSum sum;
  const Index first = next;
  for (; next < s.touches.size() && s.touches[next].frame == frame; ++next) sum += s.touches[next];
  contacts = static_cast<int>(next - first);
  if (contacts == 0) return;
  result.force = sum.force;
  result.moment = sum.moment - cross(s.frames[static_cast<Index>(frame)].shift, sum.force);
  own.force += sum.force;
  own.moment += sum.moment;
  own.dashpot += sum.dashpot;
}

int block_forces(const Model& model, State& state, Workspace& work, Index b, double dt) {
  thread_local Touches s;
  PairBlock& block = state.pair_blocks[b];
  PairGeometry& geometry = work.pair_geometry[b];
  refresh(model, state, work, block, geometry);
  const Clumps& c = state.clumps;
  s.clear();
  int last = -1;
  for (const ClumpPair& pair : block.pairs) {
    if (pair.i != last) work.own[static_cast<Index>(pair.i)] = {};
    last = pair.i;
    if (pair.count == 0) continue;
    const Index i = static_cast<Index>(pair.i), j = static_cast<Index>(pair.j);
    const StoneMotion &mi = work.motion[i], &mj = work.motion[j];
    s.frames.push_back(frame_of(mi, mj, model.pairs(c.material[i], c.material[j])));
    Losses losses;
    find_touches(pair, mi, mj, geometry, dt, block, s, losses);
    OwnSum& own = work.own[i];
    own.force.pack[3] += losses.friction;
    own.moment.pack[3] += losses.rolling;
  }
  respond<TouchKind::between_pebbles>(s, dt);

  Index next = 0;
  int frame = 0;
  for (Index k = 0; k < block.pairs.size(); ++k) {
    const Index p = static_cast<Index>(work.first_pair_of_block[b]) + k;
    work.pair_contacts[p] = 0;
    if (block.pairs[k].count == 0) continue;
    sum_touches(s, frame++, next, work.pair_results[p], work.pair_contacts[p],
                work.own[static_cast<Index>(block.pairs[k].i)]);
  }
  return static_cast<int>(s.touches.size());
}

void gather_clump(State& state, const Workspace& work, Index c) {
  Row force = 0.0, moment = 0.0;
  for (int e = work.first_entry[c]; e < work.first_entry[c + 1]; ++e) {
    const Index pair = static_cast<Index>(work.entries[static_cast<Index>(e)]);
    if (work.pair_contacts[pair] == 0) continue;
    force += work.pair_results[pair].force;
    moment += work.pair_results[pair].moment;
  }
  const OwnSum& own = work.own[c];
  StoneLosses& losses = state.clumps.losses[c];
  losses.friction += own.force[3];
  losses.rolling += own.moment[3];
  losses.dashpot += own.dashpot;
  Vec3 f = xyz(force - own.force), m = xyz(moment - own.moment);
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
  const int n = static_cast<int>(state.pair_blocks.size());
  const int n_all = n + static_cast<int>(state.wall_blocks.size());
  int touching = 0;
#pragma omp parallel for schedule(dynamic, 4) reduction(+ : touching) if (n_all > 8)
  for (int b = 0; b < n_all; ++b)
    touching += b < n ? block_forces(model, state, work, static_cast<Index>(b), dt)
                      : wall_block_forces(model, state, work, static_cast<Index>(b - n), dt);
  work.touching = touching;
}

void gather_forces(const Model& model, State& state, Workspace& work, double dt) {
#pragma omp parallel for schedule(static) if (state.clumps.size() > 64)
  for (int c = 0; c < state.clumps.size(); ++c) gather_clump(state, work, static_cast<Index>(c));
  for (Index w = 0; w < state.walls.size(); ++w) gather_wall(model, state, work, w, dt);
}

}  // namespace trackbed
