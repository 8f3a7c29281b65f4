#include "geom/mass_properties.h"

#include <gtest/gtest.h>

#include <numbers>

#include "base/rng.h"
#include "geom/primitives.h"
#include "shapes.h"

namespace trackbed {
namespace {

TEST(mass_properties, cube) {
  const MassProperties mass = mass_properties(testing::box_mesh(Vec3::Ones()));
  EXPECT_NEAR(mass.volume, 1, 1e-14);
  EXPECT_NEAR(mass.area, 6, 1e-14);
  EXPECT_TRUE(mass.centre.isApprox(Vec3::Constant(0.5), 1e-14));
  EXPECT_TRUE(mass.inertia.isApprox(Mat3::Identity() / 6, 1e-13));
}

TEST(mass_properties, block_on_wedges) {
  for (const int wedges : {1, 3}) {
    const TriangleMesh mesh = wedge_mesh({0.3, 0.2, 0.25}, std::numbers::pi / 4, wedges);
    const MassProperties mass = mass_properties(mesh);
    const double half_pitch = 0.15 / wedges;  // also the depth, for 45 degrees
    EXPECT_NEAR(mass.volume, 0.3 * 0.2 * 0.25 + wedges * half_pitch * half_pitch * 0.2, 1e-15);
    EXPECT_NEAR(mass.area,
                2 * mass.volume / 0.2 + 0.2 * (0.3 + 2 * 0.25 + wedges * 2 * std::sqrt(2.0) * half_pitch),
                1e-14);
    EXPECT_NEAR(mass.centre.x(), 0, 1e-15);
    EXPECT_NEAR(mass.centre.y(), 0, 1e-15);
    double lowest = 0;
    for (const Vec3& v : mesh.vertices) lowest = std::min(lowest, v.z());
    EXPECT_NEAR(lowest, -half_pitch, 1e-15);
  }
}

TEST(mass_properties, turned_box_far_from_the_origin) {
  const Vec3 size(3, 1, 2);
  Rng rng(7, "turn");
  const Quat turn = rng.rotation();
  const Vec3 shift(1e4, -2e4, 3e4);
  const MassProperties mass =
      mass_properties(testing::turned(testing::box_mesh(size, -size / 2), turn, shift));
  EXPECT_NEAR(mass.volume, 6, 1e-8);
  EXPECT_TRUE(mass.centre.isApprox(shift, 1e-12));
  // I_x = V (b^2 + c^2) / 12; the long axis has the smallest moment.
  EXPECT_TRUE(
      mass.principal.isApprox(Vec3(6 * (1 + 4) / 12.0, 6 * (9 + 1) / 12.0, 6 * (9 + 4) / 12.0), 1e-8));
  EXPECT_NEAR(mass.frame.determinant(), 1, 1e-12);
  EXPECT_NEAR(std::abs(mass.frame.col(0).dot(turn * Vec3::UnitX())), 1, 1e-8);
  EXPECT_NEAR(std::abs(mass.frame.col(2).dot(turn * Vec3::UnitY())), 1, 1e-8);
}

TEST(mass_properties, sphere) {
  const double radius = 0.3, volume = 4.0 / 3 * std::numbers::pi * std::pow(radius, 3);
  const MassProperties mass = mass_properties(testing::icosphere(5, radius));
  EXPECT_NEAR(mass.volume / volume, 1, 0.002);
  EXPECT_LT(mass.volume, volume);
  for (int k = 0; k < 3; ++k) EXPECT_NEAR(mass.principal[k] / (0.4 * volume * radius * radius), 1, 0.004);
  EXPECT_NEAR(mass.area / (4 * std::numbers::pi * radius * radius), 1, 0.002);
}

TEST(mass_properties, two_boxes_are_the_sum_of_their_parts) {
  TriangleMesh both = testing::box_mesh(Vec3::Ones());
  const TriangleMesh other = testing::box_mesh({2, 1, 1}, {3, 0, 0});
  for (auto facet : other.facets) {
    for (int& corner : facet) corner += 8;
    both.facets.push_back(facet);
  }
  both.vertices.insert(both.vertices.end(), other.vertices.begin(), other.vertices.end());
  const MassProperties mass = mass_properties(both);
  EXPECT_NEAR(mass.volume, 3, 1e-13);
  EXPECT_NEAR(mass.centre.x(), (0.5 + 2 * 4) / 3, 1e-13);
}

TEST(mass_properties, inside_out_has_a_negative_volume) {
  TriangleMesh mesh = testing::box_mesh(Vec3::Ones());
  for (auto& facet : mesh.facets) std::swap(facet[0], facet[1]);
  EXPECT_NEAR(mass_properties(mesh).volume, -1, 1e-14);
}

TEST(mass_properties, principal_frame_makes_the_inertia_diagonal) {
  Rng rng(3, "turn");
  const TriangleMesh mesh = testing::turned(testing::box_mesh({1, 2, 3}), rng.rotation(), {1, 2, 3});
  const MassProperties mass = mass_properties(mesh);
  const MassProperties moved = mass_properties(in_principal_frame(mesh, mass));
  EXPECT_LT(moved.centre.norm(), 1e-12);
  EXPECT_TRUE(moved.inertia.isApprox(mass.principal.asDiagonal().toDenseMatrix(), 1e-12));
}

}  // namespace
}  // namespace trackbed
