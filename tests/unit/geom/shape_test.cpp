#include "geom/shape.h"

#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <sstream>

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
