#include "dem/forces.h"

#include <array>
#include <cmath>

#include "dem/laws/table.h"
#include "dem/search.h"

namespace trackbed {
namespace {

using Index = std::size_t;

/// A clump pair ready for its contacts: everything that does not depend on the pebble.
struct PairFrame {
  Mat3 rotation_i;  // frame of i to world
  Mat3 turn;        // frame of j to frame of i
  Vec3 offset;      // of j in the frame of i [m]
  Vec3 shift;       // of j in the world [m]
  Vec3 velocity_i, velocity_j, spin_i, spin_j;
  double reduced_mass, dt;
};

PairFrame frame_of(const State& state, const Workspace& work, Index i, Index j, double dt) {
  const Clumps& c = state.clumps;
  PairFrame f;
  f.rotation_i = work.rotation[i];
  f.turn = f.rotation_i.transpose() * work.rotation[j];
  f.shift = c.position[j] - c.position[i];
  f.offset = f.rotation_i.transpose() * f.shift;
  f.velocity_i = c.velocity[i];
  f.velocity_j = c.velocity[j];
  f.spin_i = c.angular_velocity[i];
  f.spin_j = c.angular_velocity[j];
  f.reduced_mass = c.mass[i] * c.mass[j] / (c.mass[i] + c.mass[j]);
  f.dt = dt;
  return f;
}

/// Squared distances of candidates [from, to), in the frame of i.
void distances(const PairFrame& f, const double* columns, int n, int from, int to, double* distance2) {
  const double *ax = columns, *ay = columns + n, *az = columns + 2 * n;
  const double *bx = columns + 3 * n, *by = columns + 4 * n, *bz = columns + 5 * n;
  const double* m = f.turn.data();  // column by column
  const double ox = f.offset.x(), oy = f.offset.y(), oz = f.offset.z();
#pragma omp simd
  for (int k = from; k < to; ++k) {
    const double x = ox + (m[0] * bx[k] + m[3] * by[k] + m[6] * bz[k]) - ax[k];
    const double y = oy + (m[1] * bx[k] + m[4] * by[k] + m[7] * bz[k]) - ay[k];
    const double z = oz + (m[2] * bx[k] + m[5] * by[k] + m[8] * bz[k]) - az[k];
    distance2[k - from] = x * x + y * y + z * z;
  }
}

/// Ends a contact. Its last force goes on acting in the step in which it opens, on average by half: what its
/// springs held and did not give back so becomes heat.
void open_contact(const ContactProperties& p, const ContactKinematics& k, ContactMemory& memory,
                  Losses& losses) {
  if (p.ks > 0) {
    losses.friction += memory.shear.squaredNorm() / (2.0 * p.ks) - 0.5 * k.dt * memory.shear.dot(k.velocity);
    if (p.law == LawKind::linear_rolling)
      losses.rolling += memory.rolling.squaredNorm() / (2.0 * LinearRolling::rolling_stiffness(p, k.radius)) -
                        0.5 * k.dt * memory.rolling.dot(k.spin);
  }
  memory = {};
}

/// The levers of one contact, and its motion.
struct PairContact {
  Vec3 lever_i, lever_j;
  ContactKinematics kinematics;
};

PairContact contact_of(const PairFrame& f, const double* columns, int n, int k) {
  const Vec3 a(columns[k], columns[n + k], columns[2 * n + k]);
  const Vec3 b(columns[3 * n + k], columns[4 * n + k], columns[5 * n + k]);
  const double reach = columns[6 * n + k], radius_i = columns[7 * n + k];
  const Vec3 apart = f.offset + f.turn * b - a;
  const double distance = apart.norm();
  const Vec3 normal_i = apart / distance;
  const double overlap = reach - distance;

  PairContact contact;
  ContactKinematics& c = contact.kinematics;
  c.overlap = overlap;
  c.normal = f.rotation_i * normal_i;
  contact.lever_i = f.rotation_i * (a + (radius_i - 0.5 * overlap) * normal_i);
  contact.lever_j = contact.lever_i - f.shift;
  c.velocity =
      f.velocity_j + f.spin_j.cross(contact.lever_j) - f.velocity_i - f.spin_i.cross(contact.lever_i);
  c.spin = f.spin_j - f.spin_i;
  c.mean_twist = 0.5 * (f.spin_i + f.spin_j).dot(c.normal);
  c.radius = radius_i * (reach - radius_i) / reach;
  c.reduced_mass = f.reduced_mass;
  c.dt = f.dt;
  return contact;
}

template <class Law>
void touch(const PairContact& contact, const ContactProperties& p, ContactMemory& memory, PairResult& out) {
  const ContactForce response = Law::respond(contact.kinematics, p, memory, out.losses);
  out.force += response.force;
  out.moment_j += contact.lever_j.cross(response.force);
  out.moment_i -= contact.lever_i.cross(response.force);
  if constexpr (Law::rolls) {
    out.moment_j += response.moment;
    out.moment_i -= response.moment;
  }
  ++out.contacts;
}

template <class Law>
PairResult pair_forces(const PairFrame& f, const ContactProperties& p, const double* columns, int n,
                       ContactMemory* memory) {
  PairResult out{Vec3::Zero(), Vec3::Zero(), Vec3::Zero(), {}, 0};
  constexpr int chunk = 64;
  std::array<double, chunk> distance2;
  const double* reach = columns + 6 * n;
  for (int from = 0; from < n; from += chunk) {
    const int to = std::min(from + chunk, n);
    distances(f, columns, n, from, to, distance2.data());
    for (int k = from; k < to; ++k) {
      if (distance2[static_cast<Index>(k - from)] < reach[k] * reach[k]) {
        touch<Law>(contact_of(f, columns, n, k), p, memory[k], out);
      } else if (memory[k].touches()) {
        open_contact(p, contact_of(f, columns, n, k).kinematics, memory[k], out.losses);
      }
    }
  }
  return out;
}

/// The memory of the old touching place that a new one continues: the one whose normal is nearest.
ContactMemory take_memory(WallMemory& old, const Vec3& normal) {
  constexpr double still_same = 0.9;  // cosine
  ContactMemory* best = nullptr;
  double nearest = still_same;
  for (ContactMemory& m : old.points) {
    if (!m.touches() || m.normal.dot(normal) <= nearest) continue;
    nearest = m.normal.dot(normal);
    best = &m;
  }
  if (!best) return {};
  const ContactMemory taken = *best;
  *best = {};
  return taken;
}

struct WallFrame {
  Mat3 clump_rotation, wall_rotation, turn;  // turn: clump's frame to the wall's
  Vec3 offset;                               // of the clump in the wall's frame
  Vec3 shift;                                // clump to wall origin, world
  Vec3 velocity_clump, velocity_wall, spin_clump, spin_wall;
  double reduced_mass, dt;
};

/// The levers of one contact with a wall, to the middle of the overlap, and its motion.
struct WallContact {
  Vec3 lever_clump, lever_wall;
  ContactKinematics kinematics;
};

WallContact contact_of(const WallFrame& f, const WallCandidate& candidate, const Vec3& normal,
                       double overlap) {
  WallContact contact;
  contact.lever_clump = f.clump_rotation * candidate.centre + (candidate.radius - 0.5 * overlap) * normal;
  contact.lever_wall = contact.lever_clump - f.shift;
  ContactKinematics& k = contact.kinematics;
  k.overlap = overlap;
  k.normal = normal;
  k.velocity = f.velocity_wall + f.spin_wall.cross(contact.lever_wall) - f.velocity_clump -
               f.spin_clump.cross(contact.lever_clump);
  k.spin = f.spin_wall - f.spin_clump;
  k.mean_twist = 0.5 * (f.spin_wall + f.spin_clump).dot(normal);
  k.radius = candidate.radius;
  k.reduced_mass = f.reduced_mass;
  k.dt = f.dt;
  return contact;
}

/// Unit vector from the pebble to the wall. A plane is only ever met from above; with the centre on a facet
/// the pebble is taken to come from the facet's front.
Vec3 towards_wall(const WallShape& shape, const WallPoint& q, const Vec3& centre, double radius) {
  if (shape.is_plane) return {0, 0, -1};
  if (q.distance > 1e-12 * radius) return (q.point - centre) / q.distance;
  const Facet& facet = shape.facets[static_cast<Index>(q.facet)];
  return -(facet.b - facet.a).cross(facet.c - facet.a).normalized();
}

template <class Law>
void touch_wall(const WallShape& shape, const ContactProperties& p, const WallFrame& f,
                const WallCandidate& candidate, const int* facets, WallMemory& memory, WallResult& out) {
  const Vec3 centre = f.offset + f.turn * candidate.centre;
  WallPoints points;
  const int n = touching_points(shape, facets + candidate.first_facet, candidate.n_facets, centre,
                                candidate.radius, points);

  WallMemory now;
  for (int m = 0; m < n; ++m) {
    const WallPoint& q = points[static_cast<Index>(m)];
    const Vec3 normal_wall = towards_wall(shape, q, centre, candidate.radius);
    const WallContact contact =
        contact_of(f, candidate, f.wall_rotation * normal_wall, candidate.radius - q.distance);
    ContactMemory& kept = now.points[static_cast<Index>(m)];
    kept = take_memory(memory, contact.kinematics.normal);
    const ContactForce response = Law::respond(contact.kinematics, p, kept, out.losses);
    out.force += response.force;
    out.moment_wall += contact.lever_wall.cross(response.force) + response.moment;
    out.moment_clump -= contact.lever_clump.cross(response.force) + response.moment;
    ++out.contacts;
  }
  for (ContactMemory& gone : memory.points)
    if (gone.touches())
      open_contact(p, contact_of(f, candidate, gone.normal, 0.0).kinematics, gone, out.losses);
  memory = now;
}

template <class Law>
WallResult wall_forces(const Model& model, const State& state, const Workspace& work, const WallPair& pair,
                       WallBlock& block, const WallGeometry& geometry, double dt) {
  WallResult out{Vec3::Zero(), Vec3::Zero(), Vec3::Zero(), {}, 0};
  const Index c = static_cast<Index>(pair.clump), w = static_cast<Index>(pair.wall);
  WallFrame f;
  f.clump_rotation = work.rotation[c];
  f.wall_rotation = work.wall_rotation[w];
  f.turn = f.wall_rotation.transpose() * f.clump_rotation;
  f.shift = state.walls[w].pose.position - state.clumps.position[c];
  f.offset = f.wall_rotation.transpose() * -f.shift;
  f.velocity_clump = state.clumps.velocity[c];
  f.velocity_wall = state.walls[w].velocity;
  f.spin_clump = state.clumps.angular_velocity[c];
  f.spin_wall = state.walls[w].angular_velocity;
  f.reduced_mass = state.clumps.mass[c];
  if (const auto& body = model.walls[w].body) f.reduced_mass *= body->mass / (body->mass + f.reduced_mass);
  f.dt = dt;
  const ContactProperties& p = model.pairs(state.clumps.material[c], model.walls[w].material);
  for (int k = pair.first; k < pair.first + pair.count; ++k)
    touch_wall<Law>(model.walls[w].shape, p, f, geometry.candidates[static_cast<Index>(k)],
                    geometry.facets.data(), block.memory[static_cast<Index>(k)], out);
  return out;
}

void block_forces(const Model& model, State& state, Workspace& work, Index b, double dt) {
  PairBlock& block = state.pair_blocks[b];
  PairGeometry& geometry = work.pair_geometry[b];
  refresh(model, state, work, block, geometry);
  for (Index k = 0; k < block.pairs.size(); ++k) {
    const ClumpPair& pair = block.pairs[k];
    PairResult& result = work.pair_results[b * PairBlock::capacity + k];
    if (pair.count == 0) {
      result = {};  // what the last contact left, a loss of either sign, is not to be booked again
      continue;
    }
    const Index i = static_cast<Index>(pair.i), j = static_cast<Index>(pair.j);
    const ContactProperties& p = model.pairs(state.clumps.material[i], state.clumps.material[j]);
    const PairFrame f = frame_of(state, work, i, j, dt);
    with_law(p.law, [&]<class Law>() {
      result = pair_forces<Law>(
          f, p, &geometry.columns_of_pairs[static_cast<Index>(pair.first) * PairGeometry::columns],
          pair.count, &block.memory[static_cast<Index>(pair.first)]);
    });
  }
}

void wall_block_forces(const Model& model, State& state, Workspace& work, Index b, double dt) {
  WallBlock& block = state.wall_blocks[b];
  WallGeometry& geometry = work.wall_geometry[b];
  refresh(model, state, work, block, geometry);
  for (Index k = 0; k < block.pairs.size(); ++k) {
    const WallPair& pair = block.pairs[k];
    const Index c = static_cast<Index>(pair.clump), w = static_cast<Index>(pair.wall);
    const LawKind law = model.pairs(state.clumps.material[c], model.walls[w].material).law;
    with_law(law, [&]<class Law>() {
      work.wall_results[b * WallBlock::capacity + k] =
          wall_forces<Law>(model, state, work, pair, block, geometry, dt);
    });
  }
}

void gather_clump(State& state, const Workspace& work, Index c) {
  Vec3 force = Vec3::Zero(), moment = Vec3::Zero();
  StoneLosses& losses = state.clumps.losses[c];
  for (int e = work.first_entry[c]; e < work.first_entry[c + 1]; ++e) {
    const int entry = work.entries[static_cast<Index>(e)];
    const PairResult& r = work.pair_results[static_cast<Index>(entry / 2)];
    if (entry % 2) {
      force += r.force;
      moment += r.moment_j;
    } else {
      force -= r.force;
      moment += r.moment_i;
      losses += r.losses;
    }
  }
  for (int e = work.first_wall_entry[c]; e < work.first_wall_entry[c + 1]; ++e) {
    const WallResult& r = work.wall_results[static_cast<Index>(work.wall_entries[static_cast<Index>(e)])];
    force -= r.force;
    moment += r.moment_clump;
    losses += r.losses;
  }
  state.clumps.force[c] = force;
  state.clumps.moment[c] = moment;
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
#pragma omp parallel for schedule(dynamic, 4) if (n_all > 8)
  for (int b = 0; b < n_all; ++b) {
    if (b < n)
      block_forces(model, state, work, static_cast<Index>(b), dt);
    else
      wall_block_forces(model, state, work, static_cast<Index>(b - n), dt);
  }
}

void gather_forces(const Model& model, State& state, Workspace& work, double dt) {
#pragma omp parallel for schedule(static) if (state.clumps.size() > 64)
  for (int c = 0; c < state.clumps.size(); ++c) gather_clump(state, work, static_cast<Index>(c));
  for (Index w = 0; w < state.walls.size(); ++w) gather_wall(model, state, work, w, dt);
  int touching = 0;
  for (const PairResult& r : work.pair_results) touching += r.contacts;
  for (const WallResult& r : work.wall_results) touching += r.contacts;
  work.touching = touching;
}

}  // namespace trackbed
