// Contacts of stones with walls and bodies.
#include "dem/forces.h"
#include "dem/open_contact.h"
#include "dem/search.h"
#include "dem/touch.h"

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

PairFrame frame_of(const StoneMotion& stone, const Vec3& shift, const Wall& wall, const WallState& state,
                   const ContactProperties& p) {
  PairFrame f;
  double mass = stone.velocity[3];
  if (wall.body) mass *= wall.body->mass / (wall.body->mass + mass);
  const Row spin = row_of(state.angular_velocity);
  f.shift = row_of(shift);
  f.spin = spin - stone.spin;
  f.mean_spin = Lanes(0.5) * (spin + stone.spin);
  f.velocity = row_of(state.velocity) - stone.velocity - cross(spin, f.shift);
  f.velocity.pack[3] = mass;
  f.properties = &p;
  return f;
}

/// Motion of a contact that opens, at the pebble's surface.
ContactKinematics opening_of(const PairFrame& f, const Vec3& normal, double radius, const Vec3& centre,
                             double dt) {
  ContactKinematics k;
  k.spin = xyz(f.spin);
  k.velocity = xyz(f.velocity) + k.spin.cross(centre + radius * normal);
  k.radius = radius;
  k.dt = dt;
  return k;
}

/// Adds the touching places of a pair to `s`, and ends the contacts that have opened.
void find_touches(const WallFrame& f, const WallPair& pair, const WallGeometry& geometry, double dt,
                  WallBlock& block, Touches& s, Losses& losses) {
  for (Index k = static_cast<Index>(pair.first); k < static_cast<Index>(pair.first + pair.count); ++k) {
    const WallCandidate& c = geometry.candidates[k];
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
          open_contact(*s.frames.back().properties,
                       opening_of(s.frames.back(), g.normal, c.radius, lever, dt), g, losses);
    }
    s.touches.reserve(static_cast<Index>(places.n));
    for (Index m = 0; m < static_cast<Index>(places.n); ++m) {
      Touch& t = s.touches.add();
      t.between = row_of(places.normals[m], places.overlaps[m]);
      t.centre = row_of(lever, c.radius);
      t.frame = static_cast<int>(s.frames.size()) - 1;
      t.memory = &memory.points[m];
    }
  }
}

}  // namespace

int wall_block_forces(const Model& model, State& state, Workspace& work, std::size_t b, double dt) {
  thread_local Touches s;
  WallBlock& block = state.wall_blocks[b];
  WallGeometry& geometry = work.wall_geometry[b];
  if (work.way + work.wall_way >= geometry.quiet_until) refresh(model, state, work, block, geometry);
  s.clear();
  s.frames.reserve(block.pairs.size());
  WallResult* results = &work.wall_results[b * WallBlock::capacity];
  for (Index k = 0; k < block.pairs.size(); ++k) {
    const WallPair& pair = block.pairs[k];
    results[k].losses = {};
    const Index c = static_cast<Index>(pair.clump), w = static_cast<Index>(pair.wall);
    const Vec3 shift = state.walls[w].pose.position - state.clumps.position[c];
    s.frames.add() = frame_of(work.motion[c], shift, model.walls[w], state.walls[w],
                              model.pairs(state.clumps.material[c], model.walls[w].material));
    const WallFrame f{model.walls[w].shape, work.motion[c].rotation(), work.wall_rotation[w], shift};
    find_touches(f, pair, geometry, dt, block, s, results[k].losses);
  }
  respond<TouchKind::at_wall>(s, dt);

  Index next = 0;
  for (Index k = 0; k < block.pairs.size(); ++k) {
    TouchSum sum;
    for (; next < s.touches.size() && s.touches[next].frame == static_cast<int>(k); ++next)
      sum += s.touches[next];
    WallResult& r = results[k];
    r.force = xyz(sum.force);
    r.moment_clump = -xyz(sum.moment);
    r.moment_wall = xyz(sum.moment - cross(s.frames[k].shift, sum.force));
    r.losses += Losses{sum.force[3], sum.moment[3], sum.dashpot};
  }
  return static_cast<int>(s.touches.size());
}

}  // namespace trackbed
