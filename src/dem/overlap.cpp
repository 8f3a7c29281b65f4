#include "dem/overlap.h"

#include <cmath>
#include <numbers>
#include <utility>
#include <vector>

namespace trackbed {
namespace {
using Index = std::size_t;
}  // namespace

bool stones_meet(const Model& model, const Clumps& c, int i, int j, double clearance) {
  const Index a = static_cast<Index>(i), b = static_cast<Index>(j);
  const ClumpTemplate& ta = model.templates[static_cast<Index>(c.shape[a])];
  const ClumpTemplate& tb = model.templates[static_cast<Index>(c.shape[b])];
  const Pose pa{c.position[a], c.orientation[a]}, pb{c.position[b], c.orientation[b]};
  std::vector<std::pair<int, int>> stack{{0, 0}};
  while (!stack.empty()) {
    const auto [ka, kb] = stack.back();
    stack.pop_back();
    const SphereTree::Node& na = ta.tree.nodes[static_cast<Index>(ka)];
    const SphereTree::Node& nb = tb.tree.nodes[static_cast<Index>(kb)];
    const double near = c.scale[a] * na.bound.radius + c.scale[b] * nb.bound.radius + clearance;
    const Vec3 apart = pb.to_world(c.scale[b] * nb.bound.centre) - pa.to_world(c.scale[a] * na.bound.centre);
    if (apart.squaredNorm() >= near * near) continue;
    if (!na.is_leaf()) {
      stack.emplace_back(na.right, kb);
      stack.emplace_back(ka + 1, kb);
    } else if (!nb.is_leaf()) {
      stack.emplace_back(ka, nb.right);
      stack.emplace_back(ka, kb + 1);
    } else {
      for (int k = na.first; k < na.first + na.count; ++k)
        for (int l = nb.first; l < nb.first + nb.count; ++l) {
          const Pebble& p = ta.pebbles[static_cast<Index>(k)];
          const Pebble& q = tb.pebbles[static_cast<Index>(l)];
          const double reach = c.scale[a] * p.radius + c.scale[b] * q.radius + clearance;
          const Vec3 d = pb.to_world(c.scale[b] * q.centre) - pa.to_world(c.scale[a] * p.centre);
          if (d.squaredNorm() < reach * reach) return true;
        }
    }
  }
  return false;
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
