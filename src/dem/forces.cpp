// Contacts between stones, as many at a time as there are lanes, and the sums of all forces.
#include "dem/forces.h"

#include <algorithm>
#include <functional>

#include "dem/laws/table.h"
#include "dem/open_contact.h"
#include "dem/respond.h"
#include "dem/rotation.h"
#include "dem/search.h"
#include "dem/shares.h"

namespace trackbed {
namespace {

using Index = std::size_t;

/// A candidate in each lane and its memory; the last one stands in for those that are missing.
struct Batch {
  std::array<const Candidate*, Lanes::size> candidate;
  std::array<ContactMemory*, Lanes::size> memory;
  bool is_centred;  // as PairGeometry has it: nothing needs to be turned

  /// The motion of stone i or j in each lane.
  auto motions(const Workspace& work, int Candidate::*stone) const {
    return [this, &work, stone](Index k) -> const StoneMotion& {
      return work.motion[static_cast<Index>(candidate[k]->*stone)];
    };
  }
};

/// Two pebbles in each lane: where they are.
struct Places {
  Vec3Of<Lanes> shift;    // from centre of mass to centre of mass [m]
  Vec3Of<Lanes> centre;   // of pebble a from the centre of mass of i [m]
  Vec3Of<Lanes> between;  // from pebble a to pebble b [m]
  Lanes distance2;        // its square
  Lanes radius_a, reach;  // reach: sum of the radii [m]
};

/// Centres of pebbles from the centres of mass of their stones, and their radii.
template <class Motion>
Vec3Of<Lanes> place(const Motion& motion, const std::array<const Row*, Lanes::size>& pebble,
                    const Lanes& scale, Lanes& radius) {
  const Vec3Of<Lanes> body = gather([&](Index k) { return *pebble[k]; }, radius) * scale;
  radius *= scale;
  Lanes w;
  const Vec3Of<Lanes> v = gather([&](Index k) { return motion(k).turn; }, w);
  return rotated<Lanes>({w, v.x(), v.y(), v.z()}, body);
}

Places places_of(const Workspace& work, const Batch& f) {
  const auto motion_i = f.motions(work, &Candidate::i), motion_j = f.motions(work, &Candidate::j);
  std::array<const Row*, Lanes::size> a, b;
  for (Index k = 0; k < a.size(); ++k) {
    a[k] = &work.pebbles[static_cast<Index>(f.candidate[k]->a)];
    b[k] = &work.pebbles[static_cast<Index>(f.candidate[k]->b)];
  }
  Places p;
  Lanes scale_i, scale_j, radius_b;
  const Vec3Of<Lanes> x_i = gather([&](Index k) { return motion_i(k).position; }, scale_i);
  p.shift = gather([&](Index k) { return motion_j(k).position; }, scale_j) - x_i;
  if (f.is_centred) {
    const auto radii = [](const auto& pebble) { return each_lane([&](Index k) { return (*pebble[k])[3]; }); };
    p.radius_a = scale_i * radii(a);
    radius_b = scale_j * radii(b);
    p.centre = Vec3Of<Lanes>::Zero();
    p.between = p.shift;
  } else {
    p.centre = place(motion_i, a, scale_i, p.radius_a);
    p.between = p.shift + place(motion_j, b, scale_j, radius_b) - p.centre;
  }
  p.distance2 = p.between.squaredNorm();
  p.reach = p.radius_a + radius_b;
  return p;
}

/// Velocity of stone j against stone i as if both were one at the centre of mass of i, and their spins.
struct Motions {
  Vec3Of<Lanes> velocity, spin, mean_spin;
  Lanes reduced_mass;
};

Motions motions_of(const Workspace& work, const Batch& f, const Vec3Of<Lanes>& shift) {
  const auto motion_i = f.motions(work, &Candidate::i), motion_j = f.motions(work, &Candidate::j);
  Lanes mass_i, mass_j, unused;
  const Vec3Of<Lanes> v_i = gather([&](Index k) { return motion_i(k).velocity; }, mass_i);
  const Vec3Of<Lanes> v_j = gather([&](Index k) { return motion_j(k).velocity; }, mass_j);
  const Vec3Of<Lanes> w_i = gather([&](Index k) { return motion_i(k).spin; }, unused);
  const Vec3Of<Lanes> w_j = gather([&](Index k) { return motion_j(k).spin; }, unused);
  Motions m;
  m.velocity = v_j - v_i - w_j.cross(shift);
  m.spin = w_j - w_i;
  m.mean_spin = Lanes(0.5) * (w_i + w_j);
  m.reduced_mass = mass_i * mass_j / (mass_i + mass_j);
  return m;
}

/// Ends the contact in one lane that touched in the last step and touches no more.
void end_contact(const ContactProperties& p, const Places& at, const Motions& m, int lane, double dt,
                 ContactMemory& memory, Losses& losses) {
  const auto in_lane = [lane](const Vec3Of<Lanes>& v) { return Vec3(v.x()[lane], v.y()[lane], v.z()[lane]); };
  const Vec3 between = in_lane(at.between);
  const double distance = between.norm(), reach = at.reach[lane], radius = at.radius_a[lane];
  const Vec3 lever = in_lane(at.centre) + (radius - 0.5 * (reach - distance)) / distance * between;
  ContactKinematics k;
  k.spin = in_lane(m.spin);
  k.velocity = in_lane(m.velocity) + k.spin.cross(lever);
  k.radius = radius * (reach - radius) / reach;
  k.dt = dt;
  open_contact(p, k, memory, losses);
}

/// Ends the contacts in the lanes of `opened`.
void end_contacts(const Batch& f, unsigned opened, const ContactProperties& p, const Places& at,
                  const Motions& m, double dt, Workspace& work) {
  for (int lane = 0; lane < Lanes::size; ++lane) {
    if (!(opened >> lane & 1u)) continue;
    const Index k = static_cast<Index>(lane);
    Losses losses;
    end_contact(p, at, m, lane, dt, *f.memory[k], losses);
    const Index i = static_cast<Index>(f.candidate[k]->i);
    work.sums[i].moment.pack[3] += losses.friction;
    work.rare_losses[i].rolling += losses.rolling;
  }
}

/// Adds the responses in the lanes of `touching` to the sums of their stones.
template <class Law>
void hand_out(const Batch& f, unsigned touching, const Vec3Of<Lanes>& shift, const Response& r,
              const ContactProperties& p, Workspace& work) {
  const Vec3Of<Lanes> on_j = r.moment - shift.cross(r.force);
  const Rows force = rows_of({r.force.x(), r.force.y(), r.force.z(), Lanes(0.0)}),
             moment_i = rows_of({r.moment.x(), r.moment.y(), r.moment.z(), -r.losses.friction}),
             moment_j = rows_of({on_j.x(), on_j.y(), on_j.z(), Lanes(0.0)});
  const bool has_rare_losses = Law::rolls || p.dashpot.normal > 0 || p.dashpot.shear > 0;
  for (Index k = 0; k < Lanes::size; ++k) {
    if (!(touching >> k & 1u)) continue;
    const Candidate& c = *f.candidate[k];
    ForceSum& i = work.sums[static_cast<Index>(c.i)];
    i.force -= force[k];
    i.moment -= moment_i[k];
    ForceSum& j = work.sums[static_cast<Index>(c.sum_j)];
    j.force += force[k];
    j.moment += moment_j[k];
    if (!has_rare_losses) continue;
    Losses& losses = work.rare_losses[static_cast<Index>(c.i)];
    losses.rolling += r.losses.rolling[static_cast<int>(k)];
    losses.dashpot += r.losses.dashpot[static_cast<int>(k)];
  }
}

/// Without the radius, which laws that roll alone need; `lever` leads from the centre of mass of i to the
/// contact.
ContactKinematicsOf<Lanes> kinematics_of(const Places& at, const Motions& m, double dt,
                                         Vec3Of<Lanes>& lever) {
  ContactKinematicsOf<Lanes> k;
  const Lanes distance = sqrt(at.distance2);
  k.dt = dt;
  k.overlap = at.reach - distance;
  k.normal = (Lanes(1.0) / distance) * at.between;
  lever = at.centre + (at.radius_a - Lanes(0.5) * k.overlap) * k.normal;
  k.spin = m.spin;
  k.velocity = m.velocity + m.spin.cross(lever);
  k.mean_twist = m.mean_spin.dot(k.normal);
  k.reduced_mass = m.reduced_mass;
  return k;
}

/// Lets the candidates in the lanes of `present` act on their stones, in their order; returns how many touch.
int act(const Model& model, const Batch& f, unsigned present, double dt, Workspace& work) {
  const Places at = places_of(work, f);
  const unsigned touching = present & bits(at.distance2 < at.reach * at.reach);
  unsigned opened = 0;
  for (Index k = 0; k < Lanes::size; ++k) opened |= static_cast<unsigned>(f.memory[k]->touches()) << k;
  opened &= present & ~touching;
  if ((touching | opened) == 0) return 0;
  const Motions m = motions_of(work, f, at.shift);
  Vec3Of<Lanes> lever;
  ContactKinematicsOf<Lanes> kinematics = kinematics_of(at, m, dt, lever);
  const auto properties_and_end = [&](Index k) {
    return 2 * f.candidate[k]->properties + static_cast<int>(opened >> k & 1u);
  };
  by_runs(touching | opened, properties_and_end, [&](int key, unsigned run) {
    const ContactProperties& p = model.pairs[key / 2];
    if (key % 2 != 0) return end_contacts(f, run, p, at, m, dt, work);
    with_law(p.law, [&]<class Law>() {
      if constexpr (Law::rolls) kinematics.radius = at.radius_a * (at.reach - at.radius_a) / at.reach;
      hand_out<Law>(f, run, at.shift, respond_with<Law>(kinematics, p, lever, f.memory, run), p, work);
    });
  });
  return __builtin_popcount(touching);
}

/// Asks for the memory of a block that comes soon: it lies where no pattern leads the processor.
void prefetch(const PairBlock& block, const PairGeometry& geometry) {
  constexpr Index line = 64;
  const auto lines = [](const auto& values) {
    const char* at = reinterpret_cast<const char*>(values.data());
    for (Index k = 0; k < values.size() * sizeof(values[0]); k += line) __builtin_prefetch(at + k, 1);
  };
  lines(geometry.candidates);
  lines(block.memory);
}

[[gnu::flatten]] int block_forces(const Model& model, State& state, Workspace& work, Index b, double dt) {
  PairBlock& block = state.pair_blocks[b];
  PairGeometry& geometry = work.pair_geometry[b];
  if (geometry.watch.step(work.group_way)) refresh(model, state, work, block, geometry);
  int touching = 0;
  const Index n = geometry.candidates.size();
  for (Index first = 0; first < n; first += Lanes::size) {
    Batch f;
    f.is_centred = geometry.is_centred;
    for (Index k = 0; k < Lanes::size; ++k) {
      const Index at = std::min(first + k, n - 1);
      f.candidate[k] = &geometry.candidates[at];
      f.memory[k] = &block.memory[at];
    }
    touching += act(model, f, lanes_of(n - first), dt, work);
  }
  return touching;
}

int patch_forces(const Model& model, State& state, Workspace& work, Index patch, double dt) {
  const Index first = work.first_clump(static_cast<int>(patch)),
              last = work.first_clump(static_cast<int>(patch) + 1);
  std::fill(work.sums.begin() + static_cast<std::ptrdiff_t>(first),
            work.sums.begin() + static_cast<std::ptrdiff_t>(last), ForceSum{});
  std::fill(work.rare_losses.begin() + static_cast<std::ptrdiff_t>(first),
            work.rare_losses.begin() + static_cast<std::ptrdiff_t>(last), Losses{});
  std::fill(work.sums.begin() + work.first_sum_of_patch[patch],
            work.sums.begin() + work.first_sum_of_patch[patch + 1], ForceSum{});
  int touching = 0;
  const Index end = static_cast<Index>(work.first_block_of_patch[patch + 1]);
  for (Index b = static_cast<Index>(work.first_block_of_patch[patch]); b < end; ++b) {
    // A block of another patch may be growing in the hands of another thread.
    if (b + 1 < end) prefetch(state.pair_blocks[b + 1], work.pair_geometry[b + 1]);
    touching += block_forces(model, state, work, b, dt);
  }
  return touching;
}

void gather_clump(State& state, const Workspace& work, Index c) {
  Row force = work.sums[c].force, moment = work.sums[c].moment;
  StoneLosses& losses = state.clumps.losses[c];
  losses.friction += moment[3];
  losses += work.rare_losses[c];
  for (int e = work.first_sum[c]; e < work.first_sum[c + 1]; ++e) {
    const ForceSum& r = work.sums[static_cast<Index>(work.outer_sums[static_cast<Index>(e)])];
    force += r.force;
    moment += r.moment;
  }
  Vec3 f = xyz(force), m = xyz(moment);
  for (int e = work.first_wall_entry[c]; e < work.first_wall_entry[c + 1]; ++e) {
    const WallResult& r = work.wall_results[static_cast<Index>(work.wall_entries[static_cast<Index>(e)])];
    f += r.force;
    m += r.moment;
    losses += r.losses;
  }
  state.clumps.force[c] = f;
  state.clumps.moment[c] = m;
}

void gather_wall(const Model& model, State& state, const Workspace& work, Index w, double dt) {
  WallState& wall = state.walls[w];
  Vec3 force = Vec3::Zero(), moment = Vec3::Zero();
  for (int k = work.first_sum_of_wall[w]; k < work.first_sum_of_wall[w + 1]; ++k) {
    force += work.wall_sums[static_cast<Index>(k)].force;
    moment += work.wall_sums[static_cast<Index>(k)].moment;
  }
  // Work done on the stones by what keeps the velocity of a wall, or of a body along its blocked axes, with
  // the mean of the reactions before and after the step.
  const auto& body = model.walls[w].body;
  Vec3 kept = wall.velocity;
  for (int a = 0; a < 3; ++a)
    if (!keeps_velocity(model.walls[w], wall, a)) kept[a] = 0;
  Vec3 load = 0.5 * (wall.force + force);
  if (body) load += body->mass * model.gravity;
  if (body && !wall.held) load += wall.applied_force;
  wall.boundary_work -= dt * load.dot(kept);
  if (!body || wall.held) wall.boundary_work -= 0.5 * dt * (wall.moment + moment).dot(wall.angular_velocity);
  wall.force = force;
  wall.moment = moment;
}

/// Lets each thread that will come have the blocks of walls near its patches.
void fill_queues(Workspace& work) {
  work.wall_queues.resize(static_cast<Index>(omp_get_max_threads()));
  const int threads = static_cast<int>(work.wall_queues.size());
  for (int t = 0; t < threads; ++t) {
    const Share own = share_of(t, threads, work.patches());
    work.wall_queues[static_cast<Index>(t)] = {work.first_wall_block_of_patch[static_cast<Index>(own.first)],
                                               work.first_wall_block_of_patch[static_cast<Index>(own.last)]};
  }
}

/// Blocks of walls: those of this thread first, then what others have left.
int queued_wall_forces(const Model& model, State& state, Workspace& work, double dt) {
  int touching = 0;
  const Index n = work.wall_queues.size(), own = static_cast<Index>(omp_get_thread_num());
  for (Index k = 0; k < n; ++k) {
    WallQueue& queue = work.wall_queues[(own + k) % n];
    for (;;) {
      int next = 0;
#pragma omp atomic capture
      next = queue.next++;
      if (next >= queue.end) break;
      const int block = work.wall_block_order[static_cast<Index>(next)];
      touching += wall_block_forces(model, state, work, static_cast<Index>(block), dt);
    }
  }
  return touching;
}

}  // namespace

void contact_forces(const Model& model, State& state, Workspace& work, double dt) {
  fill_queues(work);
  const auto of_share = [&](const Share& own) {
    int touching = 0;
    for (int k = own.first; k < own.last; ++k)
      touching += patch_forces(model, state, work, static_cast<Index>(k), dt);
    return touching + queued_wall_forces(model, state, work, dt);
  };
  work.touching = joined_of_shares(work.patches(), of_share, std::plus());
}

void gather_forces(const Model& model, State& state, Workspace& work, double dt) {
  for_all_shares(work.patches(), [&](const Share& own) {
    for (Index c = work.first_clump(own.first); c < work.first_clump(own.last); ++c)
      gather_clump(state, work, c);
  });
  for (Index w = 0; w < state.walls.size(); ++w) gather_wall(model, state, work, w, dt);
}

}  // namespace trackbed
