#include "geom/wear.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>

#include "geom/mass_properties.h"
#include "geom/shape.h"
#include "geom/stone_generator.h"
#include "shapes.h"

namespace trackbed {
namespace {

/// A cube of side 2 about the origin, each face cut into 16 x 16 squares.
TriangleMesh fine_cube() {
  constexpr int n = 16;
  TriangleMesh mesh;
  std::map<std::array<int, 3>, int> numbers;
  const auto number = [&](const std::array<int, 3>& at) {
    const auto [found, is_new] = numbers.emplace(at, static_cast<int>(mesh.vertices.size()));
    if (is_new) mesh.vertices.push_back(Vec3(at[0], at[1], at[2]) * 2 / n - Vec3::Ones());
    return found->second;
  };
  for (std::size_t axis = 0; axis < 3; ++axis)
    for (const int side : {0, n})
      for (int i = 0; i < n; ++i)
        for (int j = 0; j < n; ++j) {
          const auto corner = [&](int di, int dj) {
            std::array<int, 3> at{};
            at[axis] = side;
            at[(axis + 1) % 3] = i + di;
            at[(axis + 2) % 3] = j + dj;
            return number(at);
          };
          const int a = corner(0, 0), b = corner(1, 0), c = corner(1, 1), d = corner(0, 1);
          if (side == n)
            mesh.facets.insert(mesh.facets.end(), {{a, b, c}, {a, c, d}});
          else
            mesh.facets.insert(mesh.facets.end(), {{a, c, b}, {a, d, c}});
        }
  return mesh;
}

TEST(wear, keeps_volume_and_centre) {
  const TriangleMesh stone = generate_stone({}, 1, 0);
  const MassProperties before = mass_properties(stone), after = mass_properties(worn(stone, 0.2));
  EXPECT_NEAR(after.volume / before.volume, 1, 1e-12);
  EXPECT_LT((after.centre - before.centre).norm(), 1e-12);
}

TEST(wear, of_nothing_changes_nothing) {
  const TriangleMesh stone = generate_stone({}, 1, 0), same = worn(stone, 0);
  for (std::size_t v = 0; v < stone.vertices.size(); ++v) EXPECT_EQ(same.vertices[v], stone.vertices[v]);
}

TEST(wear, a_ball_stays_a_ball) {
  for (const Vec3& v : worn(testing::icosphere(4, 1), 0.5).vertices) EXPECT_NEAR(v.norm(), 1, 2e-3);
}

TEST(wear, takes_corners_more_than_edges_and_leaves_faces) {
  const TriangleMesh sharp = fine_cube(), blunt = worn(sharp, 0.15);
  double corner = 0, edge = 0, face = 0;
  for (std::size_t v = 0; v < sharp.vertices.size(); ++v) {
    const Vec3 at = sharp.vertices[v].cwiseAbs();
    const double moved = (blunt.vertices[v] - sharp.vertices[v]).norm();
    if (at.minCoeff() > 0.999) corner = std::max(corner, moved);
    if (at.x() > 0.999 && at.y() > 0.999 && at.z() < 0.1) edge = std::max(edge, moved);
    if (at.z() > 0.999 && at.head<2>().norm() < 0.1) face = std::max(face, moved);
  }
  EXPECT_GT(corner, 1.3 * edge);
  EXPECT_GT(edge, 3 * face);
  EXPECT_GT(edge, 0.05);
}

TEST(wear, makes_stones_rounder_the_more_the_further) {
  const TriangleMesh stone = generate_stone({}, 2, 5);
  double roundness = 0, sphericity = 0;
  for (const double share : {0.0, 0.1, 0.2, 0.4}) {
    const Shape shape = measure_shape(worn(stone, share));
    EXPECT_GT(shape.roundness, roundness) << share;
    EXPECT_GT(shape.sphericity, sphericity) << share;
    roundness = shape.roundness;
    sphericity = shape.sphericity;
  }
}

}  // namespace
}  // namespace trackbed
