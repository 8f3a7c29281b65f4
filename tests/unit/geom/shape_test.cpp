#include "geom/shape.h"

#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <numbers>
#include <sstream>
#include <utility>
#include <vector>

#include "base/error.h"
#include "base/rng.h"
#include "geom/mesh_io.h"
#include "geom/solid.h"
#include "shapes.h"

namespace trackbed {
namespace {

TEST(shape, cube) {
  const Shape shape = measure_shape(testing::box_mesh(Vec3::Ones()));
  EXPECT_NEAR(shape.length, 1, 1e-9);
  EXPECT_NEAR(shape.elongation, 1, 1e-9);
  EXPECT_NEAR(shape.flatness, 1, 1e-9);
  EXPECT_NEAR(shape.sphericity, 0.8060, 1e-4);
  EXPECT_NEAR(shape.convexity, 1, 1e-12);
  EXPECT_NEAR(shape.sieve_size, 1, 1e-9);
}

TEST(shape, sphere) {
  const Shape shape = measure_shape(testing::icosphere(4, 0.5));
  EXPECT_NEAR(shape.sphericity, 1, 0.005);
  EXPECT_NEAR(shape.convexity, 1, 1e-9);
  EXPECT_NEAR(shape.sieve_size, 1, 0.005);
  EXPECT_NEAR(shape.thickness, 1, 0.005);
}

TEST(shape, turned_boxes_pass_along_their_longest_side) {
  Rng rng(11, "turn");
  for (const Vec3& size : {Vec3(1, 1.5, 3), Vec3(0.1, 1, 2), Vec3(0.5, 1, 1.2), Vec3(0.9, 1, 4)}) {
    const Shape shape = measure_shape(testing::turned(testing::box_mesh(size), rng.rotation(), {3, 4, 5}));
    EXPECT_NEAR(shape.length, size.z(), 0.005 * size.z());
    EXPECT_NEAR(shape.breadth, size.y(), 0.005 * size.y());
    EXPECT_NEAR(shape.thickness, size.x(), 0.005 * size.y());
    // The square around an a x b rectangle is the smaller one of b upright and (a + b) / sqrt 2 on its
    // corner.
    const double side = std::min(size.y(), (size.x() + size.y()) / std::sqrt(2));
    EXPECT_NEAR(shape.sieve_size, side, 0.005 * side);
    EXPECT_LE(std::abs(shape.box_axes.determinant() * shape.box_axes.determinant() - 1), 1e-9);
  }
}

TEST(shape, notch_lowers_the_convexity) {
  TriangleMesh mesh = testing::box_mesh({2, 2, 2}, {-1, -1, 0});
  mesh.vertices.push_back({0, 0, 0.5});  // the top pushed in by a pyramid of 2 x 2 x 1.5
  std::erase(mesh.facets, std::array<int, 3>{4, 5, 6});
  std::erase(mesh.facets, std::array<int, 3>{5, 7, 6});
  mesh.facets.insert(mesh.facets.end(), {{4, 5, 8}, {5, 7, 8}, {7, 6, 8}, {6, 4, 8}});
  EXPECT_NEAR(measure_shape(mesh).convexity, (8 - 4 * 1.5 / 3) / 8, 1e-12);
}

/// An upright prism of height 1 over an outline seen anticlockwise from above, all of which the origin sees.
TriangleMesh prism(const std::vector<std::pair<double, double>>& outline) {
  TriangleMesh mesh;
  const int n = static_cast<int>(outline.size());
  for (const double z : {0.0, 1.0})
    for (const auto& [x, y] : outline) mesh.vertices.push_back({x, y, z});
  mesh.vertices.push_back({0, 0, 0});
  mesh.vertices.push_back({0, 0, 1});
  for (int k = 0; k < n; ++k) {
    const int next = (k + 1) % n;
    mesh.facets.insert(
        mesh.facets.end(),
        {{2 * n, next, k}, {2 * n + 1, n + k, n + next}, {k, next, n + next}, {k, n + next, n + k}});
  }
  return mesh;
}

/// A polygon whose corners lie in turn at the two radii.
TriangleMesh star(int points, double outer, double inner) {
  std::vector<std::pair<double, double>> outline;
  for (int k = 0; k < 2 * points; ++k) {
    const double r = k % 2 == 0 ? outer : inner, angle = std::numbers::pi * k / points;
    outline.emplace_back(r * std::cos(angle), r * std::sin(angle));
  }
  return prism(outline);
}

TEST(roundness, of_outlines_with_a_formula) {
  const Vec3 up = Vec3::UnitZ();
  const double pi = std::numbers::pi;
  EXPECT_NEAR(outline_along(testing::box_mesh(Vec3::Ones()), up).roundness(), pi / 4, 1e-9);
  EXPECT_NEAR(outline_along(testing::box_mesh({2, 1, 1}), up).roundness(), 4 * pi * 2 / 36, 1e-9);
  EXPECT_NEAR(outline_along(star(3, 1, 0.5), up).roundness(), pi / (3 * std::sqrt(3.0)), 1e-9);  // triangle
  EXPECT_NEAR(outline_along(star(3, 1, 1), up).roundness(), pi / (2 * std::sqrt(3.0)), 1e-9);    // hexagon
  EXPECT_NEAR(outline_along(testing::icosphere(4, 1), {1, 2, 3}).roundness(), 1, 1e-3);
  EXPECT_NEAR(outline_along(cylinder_mesh(2, 1, 400), up).roundness(), 1, 1e-4);
  // A star with five points, which is not convex: ten triangles, ten sides.
  const double area = 5 * 0.4 * std::sin(pi / 5), side = std::sqrt(1 + 0.16 - 0.8 * std::cos(pi / 5));
  const Outline outline = outline_along(star(5, 1, 0.4), up);
  EXPECT_NEAR(outline.area, area, 1e-9);
  EXPECT_NEAR(outline.perimeter, 10 * side, 1e-9);
}

TEST(roundness, does_not_depend_on_where_and_how_large_the_stone_is) {
  Rng rng(3, "turn");
  const Quat turn = rng.rotation();
  const double one = outline_along(star(5, 1, 0.6), Vec3::UnitZ()).roundness();
  TriangleMesh moved = star(5, 0.05, 0.03);
  moved = testing::turned(moved, turn, {7, -3, 2});
  EXPECT_NEAR(outline_along(moved, turn * Vec3::UnitZ()).roundness(), one, 1e-6);
}

TEST(roundness, of_a_stone_is_the_mean_of_three_views) {
  const double square = std::numbers::pi / 4, oblong = 4 * std::numbers::pi * 2 / 36;
  EXPECT_NEAR(measure_shape(testing::box_mesh(Vec3::Ones())).roundness, square, 1e-6);
  EXPECT_NEAR(measure_shape(testing::box_mesh({1, 2, 1})).roundness, (square + 2 * oblong) / 3, 1e-6);
  EXPECT_NEAR(measure_shape(testing::icosphere(4, 1)).roundness, 1, 1e-3);
}

TEST(shape, flat_mesh_has_no_hull) {
  EXPECT_THROW(convex_hull({{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 1, 0}}, {}}), InputError);
}

/// The scans' own table: L, I, S [mm], sphericity and convexity, found by another program.
TEST(shape, agrees_with_the_table_of_the_scans) {
  std::ifstream table(std::filesystem::path(TRACKBED_STONES) / "stones.csv");
  if (!table) GTEST_SKIP() << "the folder of scanned stones is not here";
  std::string line;
  std::getline(table, line);
  for (int k = 0; std::getline(table, line); ++k) {
    if (k % 9 && k < 100) continue;  // every ninth of the small meshes, all of the large
    std::vector<std::string> cell;
    std::istringstream cells(line);
    for (std::string part; std::getline(cells, part, ',');) cell.push_back(part);
    if (cell[17] != "1") continue;  // extra shells count in the table and are dropped here
    SCOPED_TRACE(cell[0]);
    const double millimetre = std::stod(cell[3]) * 1e3;
    const Shape shape =
        measure_shape(make_solid(read_mesh(std::filesystem::path(TRACKBED_STONES) / cell[0]), cell[0]).mesh);
    EXPECT_NEAR(shape.sphericity, std::stod(cell[13]), 0.002);
    EXPECT_NEAR(shape.convexity, std::stod(cell[14]), 0.002);
    // Two boxes of nearly the same volume may have different sides; a better one is no error.
    const double volume = shape.length * shape.breadth * shape.thickness * std::pow(millimetre, 3);
    EXPECT_LE(volume, 1.005 * std::stod(cell[7]) * std::stod(cell[8]) * std::stod(cell[9]));
    EXPECT_GE(volume, 0.90 * std::stod(cell[7]) * std::stod(cell[8]) * std::stod(cell[9]));
    EXPECT_LE(shape.sieve_size, 1.001 * shape.breadth);
    EXPECT_GE(shape.sieve_size, 0.7 * shape.thickness);
  }
}

}  // namespace
}  // namespace trackbed
