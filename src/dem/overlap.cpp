#include "dem/overlap.h"

#include <cmath>
#include <numbers>

#include "dem/two_stones.h"

namespace trackbed {
namespace {
using Index = std::size_t;
}  // namespace

bool stones_meet(const Model& model, const Clumps& c, int i, int j, double clearance) {
  const Index a = static_cast<Index>(i), b = static_cast<Index>(j);
  const Relative pose = relative_pose(c.position[a], c.orientation[a], c.position[b], c.orientation[b]);
  return TwoStones(model, c, i, j, pose).any_within(clearance, [](int, int) { return true; });
}

bool stone_meets_wall(const Model& model, const State& state, int clump, int wall, double clearance) {
  const Clumps& c = state.clumps;
  const Index i = static_cast<Index>(clump), w = static_cast<Index>(wall);
  const ClumpTemplate& t = model.templates[static_cast<Index>(c.shape[i])];
  const WallShape& shape = model.walls[w].shape;
  const Pose stone{c.position[i], c.orientation[i]};
  const auto meets = [&](const Vec3& centre, double radius) {
    const Vec3 p = state.walls[w].pose.to_body(stone.to_world(c.scale[i] * centre));
    const double reach = c.scale[i] * radius + clearance;
    if (shape.is_plane) return p.z() < reach;
    return any_near_facet(shape, p, reach, [](int, double) { return true; });
  };
  return t.tree.any([&](const Sphere& bound) { return meets(bound.centre, bound.radius); },
                    [&](int p) {
                      const Pebble& pebble = t.pebbles[static_cast<Index>(p)];
                      return meets(pebble.centre, pebble.radius);
                    });
}

bool is_inside(const WallShape& shape, const Vec3& point) {
  // Sum of the solid angles of the facets (van Oosterom & Strackee 1983).
  double angle = 0;
  for (const Facet& f : shape.facets) {
    const Vec3 a = f.a - point, b = f.b - point, c = f.c - point;
    const double la = a.norm(), lb = b.norm(), lc = c.norm();
    angle +=
        2.0 * std::atan2(a.dot(b.cross(c)), la * lb * lc + a.dot(b) * lc + b.dot(c) * la + c.dot(a) * lb);
  }
  return angle > 2.0 * std::numbers::pi;
}

}  // namespace trackbed
