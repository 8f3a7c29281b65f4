#include "geom/primitives.h"

#include <cmath>
#include <map>
#include <numbers>
#include <utility>
#include <vector>

namespace trackbed {

TriangleMesh box_mesh(const Vec3& size, const Vec3& low) {
  TriangleMesh mesh;
  for (int k = 0; k < 8; ++k)
    mesh.vertices.push_back(low + Vec3(k & 1 ? size.x() : 0, k & 2 ? size.y() : 0, k & 4 ? size.z() : 0));
  mesh.facets = {{0, 2, 1}, {1, 2, 3}, {4, 5, 6}, {5, 7, 6}, {0, 1, 4}, {1, 5, 4},
                 {2, 6, 3}, {3, 6, 7}, {0, 4, 2}, {2, 4, 6}, {1, 3, 5}, {3, 7, 5}};
  return mesh;
}

TriangleMesh wedge_mesh(const Vec3& size, double angle, int wedges) {
  // The outline from above, anticlockwise seen against y: top left, the teeth from left to right, top right.
  const double x = 0.5 * size.x(), y = 0.5 * size.y(), pitch = size.x() / wedges;
  const double depth = 0.5 * pitch * std::tan(angle);
  std::vector<Vec3> outline{{-x, 0, size.z()}, {-x, 0, 0}};
  for (int k = 0; k < wedges; ++k) {
    outline.push_back({-x + (k + 0.5) * pitch, 0, -depth});
    outline.push_back({-x + (k + 1) * pitch, 0, 0});
  }
  outline.push_back({x, 0, size.z()});
  // Front at -y, back at y; the parts of each: a tooth, and above its base a triangle up to the top left.
  const int n = static_cast<int>(outline.size());
  TriangleMesh mesh;
  for (const double side : {-y, y})
    for (const Vec3& p : outline) mesh.vertices.push_back({p.x(), side, p.z()});
  const auto add_face = [&](int a, int b, int c) {
    mesh.facets.push_back({a, b, c});
    mesh.facets.push_back({n + a, n + c, n + b});
  };
  for (int k = 0; k < wedges; ++k) {
    const int left = 1 + 2 * k;
    add_face(left, left + 1, left + 2);
    add_face(0, left, left + 2);
  }
  add_face(0, n - 2, n - 1);
  for (int k = 0; k < n; ++k) {
    const int next = (k + 1) % n;
    mesh.facets.push_back({k, n + k, n + next});
    mesh.facets.push_back({k, n + next, next});
  }
  return mesh;
}

TriangleMesh cylinder_mesh(double diameter, double height, int sides) {
  TriangleMesh mesh;
  for (const double z : {0.0, height})
    for (int k = 0; k < sides; ++k) {
      const double angle = 2 * std::numbers::pi * k / sides;
      mesh.vertices.push_back({0.5 * diameter * std::cos(angle), 0.5 * diameter * std::sin(angle), z});
    }
  const int base = 2 * sides, top = base + 1;
  mesh.vertices.push_back({0, 0, 0});
  mesh.vertices.push_back({0, 0, height});
  for (int k = 0; k < sides; ++k) {
    const int next = (k + 1) % sides;
    mesh.facets.insert(mesh.facets.end(), {{base, next, k},
                                           {top, sides + k, sides + next},
                                           {k, next, sides + next},
                                           {k, sides + next, sides + k}});
  }
  return mesh;
}

void add_rectangle(TriangleMesh& mesh, const Vec3& corner, const Vec3& a, const Vec3& b) {
  const int n = static_cast<int>(mesh.vertices.size());
  mesh.vertices.insert(mesh.vertices.end(), {corner, corner + a, corner + a + b, corner + b});
  mesh.facets.insert(mesh.facets.end(), {{n, n + 1, n + 2}, {n, n + 2, n + 3}});
}

TriangleMesh icosphere(int level, double radius) {
  const double g = (1 + std::sqrt(5.0)) / 2;
  TriangleMesh mesh;
  mesh.vertices = {{-1, g, 0},  {1, g, 0},  {-1, -g, 0}, {1, -g, 0}, {0, -1, g},  {0, 1, g},
                   {0, -1, -g}, {0, 1, -g}, {g, 0, -1},  {g, 0, 1},  {-g, 0, -1}, {-g, 0, 1}};
  mesh.facets = {{0, 11, 5},  {0, 5, 1},  {0, 1, 7},  {0, 7, 10}, {0, 10, 11}, {1, 5, 9}, {5, 11, 4},
                 {11, 10, 2}, {10, 7, 6}, {7, 1, 8},  {3, 9, 4},  {3, 4, 2},   {3, 2, 6}, {3, 6, 8},
                 {3, 8, 9},   {4, 9, 5},  {2, 4, 11}, {6, 2, 10}, {8, 6, 7},   {9, 8, 1}};
  for (int k = 0; k < level; ++k) {
    std::map<std::pair<int, int>, int> midpoints;
    const auto midpoint = [&](int a, int b) {
      const auto [found, is_new] =
          midpoints.try_emplace(std::minmax(a, b), static_cast<int>(mesh.vertices.size()));
      if (is_new)
        mesh.vertices.push_back(
            (mesh.vertices[static_cast<std::size_t>(a)] + mesh.vertices[static_cast<std::size_t>(b)])
                .normalized());
      return found->second;
    };
    for (Vec3& v : mesh.vertices) v.normalize();
    std::vector<std::array<int, 3>> finer;
    for (const auto& [a, b, c] : mesh.facets) {
      const int ab = midpoint(a, b), bc = midpoint(b, c), ca = midpoint(c, a);
      finer.insert(finer.end(), {{a, ab, ca}, {ab, b, bc}, {ca, bc, c}, {ab, bc, ca}});
    }
    mesh.facets = std::move(finer);
  }
  for (Vec3& v : mesh.vertices) v *= radius / v.norm();
  return mesh;
}

}  // namespace trackbed
