#include "geom/clump_template.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <utility>

#include "base/error.h"

namespace trackbed {

ClumpTemplate make_clump_template(std::string name, std::vector<Pebble> pebbles, double volume,
                                  const Vec3& inertia, TriangleMesh surface, double sieve_size) {
  if (pebbles.empty()) throw InputError("stone " + name + " has no pebble");
  std::vector<Sphere> spheres;
  for (const Pebble& p : pebbles) {
    if (!(p.radius > 0) || !p.centre.allFinite())
      throw InputError("stone " + name + " has a pebble without a positive radius");
    spheres.push_back({p.centre, p.radius});
  }

  ClumpTemplate t;
  t.name = std::move(name);
  t.tree = SphereTree(spheres);
  t.smallest_radius = std::numeric_limits<double>::infinity();
  for (int k : t.tree.order()) {
    const Pebble& p = pebbles[static_cast<std::size_t>(k)];
    t.pebbles.push_back(p);
    t.bounding_radius = std::max(t.bounding_radius, p.centre.norm() + p.radius);
    t.smallest_radius = std::min(t.smallest_radius, p.radius);
  }
  t.surface = std::move(surface);
  t.volume = t.pebble_volume = volume;
  t.inertia = inertia;
  t.sieve_size = sieve_size;
  return t;
}

ClumpTemplate make_ball_template(double radius) {
  const double volume = 4.0 / 3.0 * std::numbers::pi * radius * radius * radius;
  return make_clump_template("ball", {{Vec3::Zero(), radius}}, volume,
                             Vec3::Constant(0.4 * volume * radius * radius), {}, 2.0 * radius);
}

ClumpTemplate make_disc_template(double radius, double thickness) {
  const double volume = std::numbers::pi * radius * radius * thickness;
  return make_clump_template("disc", {{Vec3::Zero(), radius}}, volume,
                             Vec3::Constant(0.5 * volume * radius * radius), {}, 2.0 * radius);
}

ClumpTemplate make_stand_in(const ClumpTemplate& clump) {
  const double radius = std::cbrt(0.75 * clump.pebble_volume / std::numbers::pi);
  return make_clump_template("stand-in for " + clump.name, {{Vec3::Zero(), radius}}, clump.volume,
                             Vec3::Constant(0.4 * clump.volume * radius * radius), {}, 2.0 * radius);
}

}  // namespace trackbed
