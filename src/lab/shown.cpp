#include "lab/shown.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>

#include "geom/primitives.h"

namespace trackbed {
namespace {

using Index = std::size_t;

/// Facets of each of so many stones: some 400 MB in all while they are written.
int facets_for(int stones) {
  constexpr int most_in_all = 5'000'000, least = 20, most = 1280;
  return std::clamp(most_in_all / std::max(1, stones), least, most);
}

/// Refinement of an icosahedron to so many facets.
int ball_level(int facets) {
  int level = 0;
  while ((20 << (2 * (level + 1))) <= facets) ++level;
  return level;
}

/// The mesh, or one with about so many facets if it has more.
TriangleMesh coarse(const TriangleMesh& mesh, double bounding_radius, int facets) {
  if (mesh.facets.size() <= static_cast<Index>(facets)) return mesh;
  constexpr double facets_at_one_cell = 20;  // where cells are as large as the bounding radius
  return merge_vertices(mesh, bounding_radius / std::sqrt(facets / facets_at_one_cell));
}

void add_ball(TriangleMesh& mesh, const Pebble& pebble, int level) {
  const TriangleMesh ball = icosphere(level, pebble.radius);
  const int first = static_cast<int>(mesh.vertices.size());
  for (const Vec3& v : ball.vertices) mesh.vertices.push_back(pebble.centre + v);
  for (const auto& [a, b, c] : ball.facets) mesh.facets.push_back({first + a, first + b, first + c});
}

}  // namespace

TriangleMesh merge_vertices(const TriangleMesh& mesh, double cell) {
  TriangleMesh merged;
  std::map<std::array<int, 3>, int> vertex_in;
  std::vector<int> count, new_index;
  for (const Vec3& v : mesh.vertices) {
    std::array<int, 3> at;
    for (int a = 0; a < 3; ++a) at[static_cast<Index>(a)] = static_cast<int>(std::floor(v[a] / cell));
    const auto [found, is_new] = vertex_in.try_emplace(at, static_cast<int>(merged.vertices.size()));
    if (is_new) {
      merged.vertices.push_back(Vec3::Zero());
      count.push_back(0);
    }
    new_index.push_back(found->second);
    merged.vertices[static_cast<Index>(found->second)] += v;
    ++count[static_cast<Index>(found->second)];
  }
  for (Index k = 0; k < count.size(); ++k) merged.vertices[k] /= count[k];
  for (const auto& facet : mesh.facets) {
    std::array<int, 3> f;
    for (Index k = 0; k < 3; ++k) f[k] = new_index[static_cast<Index>(facet[k])];
    if (f[0] != f[1] && f[1] != f[2] && f[2] != f[0]) merged.facets.push_back(f);
  }
  return merged;
}

std::vector<TriangleMesh> shown_surfaces(const Model& model, int stones) {
  std::vector<TriangleMesh> shown;
  const int facets = facets_for(stones);
  for (const ClumpTemplate& t : model.templates) {
    TriangleMesh mesh = coarse(t.surface, t.bounding_radius, facets);
    if (mesh.facets.empty())
      for (const Pebble& pebble : t.pebbles)
        add_ball(mesh, pebble, t.pebbles.size() == 1 ? ball_level(facets) : 1);
    shown.push_back(std::move(mesh));
  }
  return shown;
}

std::vector<PosedMesh> posed_stones(const State& state, const std::vector<TriangleMesh>& surfaces) {
  std::vector<PosedMesh> stones;
  const Clumps& c = state.clumps;
  for (Index i = 0; i < c.id.size(); ++i)
    stones.push_back(
        {&surfaces[static_cast<Index>(c.shape[i])], {c.position[i], c.orientation[i]}, c.scale[i]});
  return stones;
}

}  // namespace trackbed
