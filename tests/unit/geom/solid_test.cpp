#include "geom/solid.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <set>

#include "base/error.h"
#include "geom/mass_properties.h"
#include "geom/mesh_io.h"
#include "shapes.h"

namespace trackbed {
namespace {

void append(TriangleMesh& mesh, const TriangleMesh& other) {
  const int shift = static_cast<int>(mesh.vertices.size());
  mesh.vertices.insert(mesh.vertices.end(), other.vertices.begin(), other.vertices.end());
  for (const auto& f : other.facets) mesh.facets.push_back({f[0] + shift, f[1] + shift, f[2] + shift});
}

std::string refusal(const TriangleMesh& mesh) {
  try {
    make_solid(mesh, "rubble");
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
}

std::string repairs(const Solid& solid) {
  std::string all;
  for (const std::string& repair : solid.repairs) all += repair + "; ";
  return all;
}

/// Every directed edge once and its reverse once: closed, manifold along edges, one sense of turning.
void expect_closed(const TriangleMesh& mesh) {
  std::set<std::pair<int, int>> edges;
  for (const auto& f : mesh.facets)
    for (std::size_t k = 0; k < 3; ++k) EXPECT_TRUE(edges.insert({f[k], f[(k + 1) % 3]}).second);
  for (const auto& [a, b] : edges) EXPECT_TRUE(edges.contains({b, a}));
  EXPECT_GT(mass_properties(mesh).volume, 0);
}

void expect_repaired(const TriangleMesh& mesh, const std::string& word, double volume) {
  const Solid solid = make_solid(mesh, "rubble");
  EXPECT_NE(repairs(solid).find(word), std::string::npos) << repairs(solid);
  expect_closed(solid.mesh);
  EXPECT_NEAR(mass_properties(solid.mesh).volume / volume, 1, 1e-3);
}

const TriangleMesh ball = testing::icosphere(3, 1);
const double ball_volume = mass_properties(ball).volume;

TEST(solid, a_sound_mesh_is_left_alone) {
  const Solid solid = make_solid(ball, "ball");
  EXPECT_TRUE(solid.repairs.empty());
  EXPECT_EQ(solid.mesh.facets, ball.facets);
}

TEST(solid, every_vertex_doubled) {
  TriangleMesh soup;
  for (std::size_t f = 0; f < ball.facets.size(); ++f) {
    const int first = static_cast<int>(soup.vertices.size());
    for (const Vec3& corner : ball.corners(f)) soup.vertices.push_back(corner);
    soup.facets.push_back({first, first + 1, first + 2});
  }
  expect_repaired(soup, "merged 3198 doubled vertices", ball_volume);
}

TEST(solid, doubled_flat_and_unused_parts) {
  TriangleMesh mesh = ball;
  mesh.facets.push_back(mesh.facets[7]);
  mesh.facets.push_back({3, 3, 5});
  mesh.vertices.push_back({9, 9, 9});
  expect_repaired(mesh, "dropped 1 doubled facet", ball_volume);
  expect_repaired(mesh, "dropped 1 facet without area", ball_volume);
  expect_repaired(mesh, "dropped 1 unused vertex", ball_volume);
}

TEST(solid, facet_whose_corners_lie_on_a_line) {
  TriangleMesh mesh = testing::box_mesh(Vec3::Ones());
  // A vertex in the middle of the lower front edge, used on one side only: a facet of no area closes the gap.
  mesh.vertices.push_back({0.5, 0, 0});
  mesh.facets.erase(mesh.facets.begin() + 4);  // {0, 1, 4}
  mesh.facets.insert(mesh.facets.end(), {{0, 8, 4}, {8, 1, 4}, {0, 1, 8}});
  expect_repaired(mesh, "removed 1 facet without area", 1);
}

TEST(solid, turned_facets) {
  TriangleMesh mesh = ball;
  for (std::size_t f = 0; f < 5; ++f) std::swap(mesh.facets[100 * f][0], mesh.facets[100 * f][1]);
  expect_repaired(mesh, "turned 5 facets", ball_volume);
  for (auto& facet : mesh.facets) std::swap(facet[0], facet[1]);
  expect_repaired(mesh, "inside out", ball_volume);
}

TEST(solid, small_holes_are_closed_and_large_ones_refused) {
  TriangleMesh mesh = ball;
  mesh.facets.erase(mesh.facets.begin() + 40, mesh.facets.begin() + 43);
  expect_repaired(mesh, "closed", ball_volume);
  mesh.facets.resize(mesh.facets.size() / 2);
  EXPECT_NE(refusal(mesh).find("rubble: the mesh is open"), std::string::npos) << refusal(mesh);
}

TEST(solid, small_shells_are_dropped_and_large_ones_refused) {
  TriangleMesh mesh = ball;
  append(mesh, testing::turned(testing::icosphere(1, 0.2), Quat::Identity(), {2, 0, 0}));
  expect_repaired(mesh, "dropped 1 small extra shell", ball_volume);
  append(mesh, testing::turned(ball, Quat::Identity(), {0, 5, 0}));
  EXPECT_NE(refusal(mesh).find("3 separate bodies"), std::string::npos) << refusal(mesh);
}

TEST(solid, two_boxes_that_touch_in_an_edge_are_two_bodies) {
  TriangleMesh mesh = testing::box_mesh(Vec3::Ones());
  append(mesh, testing::box_mesh(Vec3::Ones(), {1, 1, 0}));
  EXPECT_NE(refusal(mesh).find("2 separate bodies"), std::string::npos) << refusal(mesh);
}

TEST(solid, a_vertex_pushed_through_the_other_side) {
  TriangleMesh mesh = ball;
  mesh.vertices[50] *= -1.3;
  EXPECT_NE(refusal(mesh).find("cross other facets"), std::string::npos) << refusal(mesh);
  // A fold of a scan: one vertex slipped past its neighbours along the surface.
  TriangleMesh fold = testing::icosphere(5, 1);
  fold.vertices[5000] = (fold.vertices[5000] + Vec3(0, 0, 0.12).cross(fold.vertices[5000])).normalized();
  expect_repaired(fold, "renewed the surface", mass_properties(testing::icosphere(5, 1)).volume);
}

TEST(solid, flat_and_tiny_meshes_are_refused) {
  TriangleMesh sheet = testing::box_mesh({1, 1, 0});
  EXPECT_FALSE(refusal(sheet).empty());
  EXPECT_FALSE(refusal({}).empty());
  EXPECT_FALSE(refusal({{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {{0, 1, 2}}}).empty());
  EXPECT_FALSE(refusal({{{0, 0, 0}, {1, 0, 0}}, {{0, 1, 2}}}).empty());
}

TEST(solid, all_scans_pass) {
  if (!std::filesystem::exists(TRACKBED_STONES)) GTEST_SKIP() << "the folder of scanned stones is not here";
  int scans = 0;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(TRACKBED_STONES)) {
    const auto ending = entry.path().extension();
    if (ending != ".obj" && ending != ".stl") continue;
    SCOPED_TRACE(entry.path().string());
    ++scans;
    const TriangleMesh mesh = read_mesh(entry.path());
    const Solid solid = make_solid(mesh, entry.path().filename().string());
    expect_closed(solid.mesh);
    EXPECT_NEAR(mass_properties(solid.mesh).volume / std::abs(mass_properties(mesh).volume), 1, 0.01);
    EXPECT_TRUE(make_solid(solid.mesh, "again").repairs.empty());
  }
  EXPECT_EQ(scans, 111);
}

}  // namespace
}  // namespace trackbed
