// Contacts of stones with walls and bodies.
#include "dem/forces.h"

#include <algorithm>

#include "dem/laws/table.h"
#include "dem/open_contact.h"
#include "dem/respond.h"
#include "dem/search.h"

namespace trackbed {
namespace {

using Index = std::size_t;

/// Puts the memory of each old touching place where the new one that continues it stands: the one whose
/// normal is nearest. Places that have no old one start empty.
void sort_memory(const std::array<Vec3, max_wall_points>& normals, int n, WallMemory& memory,
                 WallMemory& gone) {
  constexpr double still_same = 0.9;  // cosine
  gone = memory;
  memory = {};
  for (int m = 0; m < n; ++m) {
    ContactMemory* best = nullptr;
    double nearest = still_same;
    for (ContactMemory& old : gone.points) {
      const double cosine = old.normal.dot(normals[static_cast<Index>(m)]);
      if (!old.touches() || cosine <= nearest) continue;
      nearest = cosine;
      best = &old;
    }
    if (!best) continue;
    memory.points[static_cast<Index>(m)] = *best;
    *best = {};
  }
}

/// The motion of a wall against a stone as if both were one at the stone's centre of mass.
struct PairMotion {
  Row velocity;   // [m/s], and the reduced mass [kg]
  Row spin;       // [rad/s]
  Row mean_spin;  // [rad/s]
  Row shift;      // from the stone's centre of mass to the wall's origin [m]
  int properties;
  int sum;  // in Workspace::wall_sums
};

/// A place where a pebble touches a wall.
struct Touch {
  Row normal;  // to the wall, and the overlap [m]
  Row centre;  // of the pebble from the stone's centre of mass [m], and its radius [m]
  int pair;
  ContactMemory* memory;
};

/// Per-thread memory of one block's contacts, kept so that a step allocates nothing.
struct Touches {
  std::vector<PairMotion> motions;
  std::vector<Touch> touches;

  void clear() {
    motions.clear();
    touches.clear();
  }
};

/// A clump and a wall: everything that does not depend on the pebble.
struct WallFrame {
  const WallShape& shape;
  Mat3 clump_rotation, wall_rotation;
  Vec3 shift;  // clump to wall origin, world [m]
};

/// Unit vector from the pebble to the wall. With the centre on a facet the pebble is taken to come from the
/// facet's front.
Vec3 towards_wall(const WallShape& shape, const WallPoint& q, const Vec3& centre, double radius) {
  if (q.distance > 1e-12 * radius) return (q.point - centre) / q.distance;
  const Facet& facet = shape.facets[static_cast<Index>(q.facet)];
  return -(facet.b - facet.a).cross(facet.c - facet.a).normalized();
}

/// Where one pebble touches the wall: normals (world) and overlaps.
struct Places {
  int n = 0;
  std::array<Vec3, max_wall_points> normals;
  std::array<double, max_wall_points> overlaps;
};

Places places_of(const WallFrame& f, const WallCandidate& c, const Vec3& lever, const int* facets) {
  Places out;
  if (f.shape.is_plane) {  // only ever met from above
    const Vec3 normal = -f.wall_rotation.col(2);
    const double overlap = c.radius + normal.dot(lever - f.shift);
    if (overlap <= 0) return out;
    out.n = 1;
    out.normals[0] = normal;
    out.overlaps[0] = overlap;
    return out;
  }
  const Vec3 centre = f.wall_rotation.transpose() * (lever - f.shift);
  WallPoints points;
  out.n = touching_points(f.shape, facets + c.first_facet, c.n_facets, centre, c.radius, points);
  for (Index m = 0; m < static_cast<Index>(out.n); ++m) {
    out.normals[m] = f.wall_rotation * towards_wall(f.shape, points[m], centre, c.radius);
    out.overlaps[m] = c.radius - points[m].distance;
  }
  return out;
}

PairMotion motion_of(const StoneMotion& stone, const Vec3& shift, const Wall& wall, const WallState& state) {
  PairMotion m;
  double mass = stone.velocity[3];
  if (wall.body) mass *= wall.body->mass / (wall.body->mass + mass);
  const Row spin = row_of(state.angular_velocity);
  m.shift = row_of(shift);
  m.spin = spin - stone.spin;
  m.mean_spin = Row(0.5) * (spin + stone.spin);
  m.velocity = row_of(state.velocity) - stone.velocity - cross(spin, m.shift);
  m.velocity.pack[3] = mass;
  return m;
}

/// Motion of a contact that opens, at the pebble's surface.
ContactKinematics opening_of(const PairMotion& m, const Vec3& normal, double radius, const Vec3& centre,
                             double dt) {
  ContactKinematics k;
  k.spin = xyz(m.spin);
  k.velocity = xyz(m.velocity) + k.spin.cross(centre + radius * normal);
  k.radius = radius;
  k.dt = dt;
  return k;
}

/// Adds the touching places of a pair to `s`, and ends the contacts that have opened.
void find_touches(const WallFrame& f, const WallPair& pair, const WallGeometry& geometry, double tested,
                  const ContactProperties& p, double dt, WallBlock& block, Touches& s, Losses& losses) {
  for (Index k = static_cast<Index>(pair.first); k < static_cast<Index>(pair.first + pair.count); ++k) {
    const WallCandidate& c = geometry.candidates[k];
    if (c.gap > tested) continue;
    const Vec3 lever = f.clump_rotation * c.centre;
    const Places places = places_of(f, c, lever, geometry.facets.data());
    WallMemory& memory = block.memory[k];
    const auto& points = memory.points;
    const bool is_one = !points[1].touches() && !points[2].touches() && places.n <= 1 &&
                        (places.n == 1 || !points[0].touches());
    if (!is_one || (places.n == 1 && points[0].touches() && points[0].normal.dot(places.normals[0]) < 0.99)) {
      WallMemory gone;
      sort_memory(places.normals, places.n, memory, gone);
      for (ContactMemory& g : gone.points)
        if (g.touches())
          open_contact(p, opening_of(s.motions.back(), g.normal, c.radius, lever, dt), g, losses);
    }
    const int number = static_cast<int>(s.motions.size()) - 1;
    for (Index m = 0; m < static_cast<Index>(places.n); ++m)
      s.touches.push_back({row_of(places.normals[m], places.overlaps[m]), row_of(lever, c.radius), number,
                           &memory.points[m]});
  }
}

/// A touch in each lane; the last one stands in for those that are missing.
using Batch = std::array<const Touch*, Lanes::size>;

/// Lets the touches of a batch respond, those in the lanes of `wanted`.
template <class Law>
void respond(const Batch& f, unsigned wanted, const Touches& s, const ContactProperties& p, double dt,
             WallResult* results, WallSum* sums) {
  const auto motion = [&](Index n) -> const PairMotion& { return s.motions[static_cast<Index>(f[n]->pair)]; };
  Lanes unused;
  ContactKinematicsOf<Lanes> k;
  k.dt = dt;
  k.normal = gather([&](Index n) { return f[n]->normal; }, k.overlap);
  const Vec3Of<Lanes> centre = gather([&](Index n) { return f[n]->centre; }, k.radius);
  const Vec3Of<Lanes> lever = centre + (k.radius - Lanes(0.5) * k.overlap) * k.normal;
  k.spin = gather([&](Index n) { return motion(n).spin; }, unused);
  k.velocity = gather([&](Index n) { return motion(n).velocity; }, k.reduced_mass);
  k.velocity += k.spin.cross(lever);
  k.mean_twist = gather([&](Index n) { return motion(n).mean_spin; }, unused).dot(k.normal);
  const Vec3Of<Lanes> shift = gather([&](Index n) { return motion(n).shift; }, unused);
  std::array<ContactMemory*, Lanes::size> memories;
  for (Index n = 0; n < memories.size(); ++n) memories[n] = f[n]->memory;
  const Response r = respond_with<Law>(k, p, lever, memories, wanted);
  const Vec3Of<Lanes> on_wall = r.moment - shift.cross(r.force);
  for (int lane = 0; lane < Lanes::size; ++lane) {
    if (!(wanted >> lane & 1u)) continue;
    const auto in_lane = [lane](const Vec3Of<Lanes>& v) {
      return Vec3(v.x()[lane], v.y()[lane], v.z()[lane]);
    };
    WallResult& out = results[f[static_cast<Index>(lane)]->pair];
    out.force -= in_lane(r.force);
    out.moment -= in_lane(r.moment);
    WallSum& sum = sums[s.motions[static_cast<Index>(f[static_cast<Index>(lane)]->pair)].sum];
    sum.force += in_lane(r.force);
    sum.moment += in_lane(on_wall);
    out.losses += Losses{r.losses.friction[lane], r.losses.rolling[lane], r.losses.dashpot[lane]};
  }
}

/// Lets all touches of a block respond.
void respond(const Model& model, const Touches& s, double dt, WallResult* results, WallSum* sums) {
  const Index n = s.touches.size();
  for (Index first = 0; first < n; first += Lanes::size) {
    Batch f;
    for (Index k = 0; k < Lanes::size; ++k) f[k] = &s.touches[std::min(first + k, n - 1)];
    by_runs(
        lanes_of(n - first), [&](Index k) { return s.motions[static_cast<Index>(f[k]->pair)].properties; },
        [&](int properties, unsigned wanted) {
          const ContactProperties& p = model.pairs[properties];
          with_law(p.law, [&]<class Law>() { respond<Law>(f, wanted, s, p, dt, results, sums); });
        });
  }
}

}  // namespace

[[gnu::flatten]] int wall_block_forces(const Model& model, State& state, Workspace& work, std::size_t b,
                                       double dt) {
  thread_local Touches s;
  WallBlock& block = state.wall_blocks[b];
  WallGeometry& geometry = work.wall_geometry[b];
  if (geometry.watch.step(work.group_way, work.wall_step_way)) refresh(model, state, work, block, geometry);
  s.clear();
  WallResult* results = &work.wall_results[static_cast<Index>(geometry.first_pair)];
  for (Index k = 0; k < block.pairs.size(); ++k) {
    const WallPair& pair = block.pairs[k];
    results[k] = {};
    const Index c = static_cast<Index>(pair.clump), w = static_cast<Index>(pair.wall);
    const Vec3 shift = state.walls[w].pose.position - state.clumps.position[c];
    s.motions.push_back(motion_of(work.motion[c], shift, model.walls[w], state.walls[w]));
    s.motions.back().sum = work.sum_of_wall_pair[static_cast<Index>(geometry.first_pair) + k];
    work.wall_sums[static_cast<Index>(s.motions.back().sum)] = {};
    s.motions.back().properties = model.pairs.index(state.clumps.material[c], model.walls[w].material);
    const WallFrame f{model.walls[w].shape, state.clumps.orientation[c].toRotationMatrix(),
                      work.wall_rotation[w], shift};
    find_touches(f, pair, geometry, geometry.tested[k], model.pairs[s.motions.back().properties], dt, block,
                 s, results[k].losses);
  }
  respond(model, s, dt, results, work.wall_sums.data());
  return static_cast<int>(s.touches.size());
}

}  // namespace trackbed
