#include "fem/soil.h"

#include <gtest/gtest.h>

#include "base/error.h"
#include "fem/assembly.h"
#include "scenes/strip_of_soil.h"

namespace trackbed::fem {
namespace {

TEST(Soil, ShoulderGoesDownInStepsOfAnElement) {
  const Soil soil = make_soil(strip_of_soil());  // crest 0.9 m of 1.2 m, slope 1, elements of 0.15 m
  const Section& s = soil.section;
  EXPECT_EQ(s.across, 8);
  EXPECT_EQ(s.up, 5);
  for (int j = 0; j < 8; ++j) {
    EXPECT_EQ(s.material(j, 2), 1);               // subgrade in full width
    EXPECT_EQ(s.material(j, 3), j < 7 ? 0 : -1);  // middle at 0.225 m depth: to 1.125 m
    EXPECT_EQ(s.material(j, 4), j < 6 ? 0 : -1);  // 0.075 m: to 0.975 m
  }
  EXPECT_EQ(soil.section_size(), 3 * 9 + 9 + 8 + 7);  // of 6 rows of points
  EXPECT_EQ(soil.nodes(), 21 * soil.section_size());
}

TEST(Soil, FootingsLieOnTheTopUnderTheSleepers) {
  const Soil soil = make_soil(strip_of_soil());
  const HexMesh mesh = extrude(soil.section, 0, 0.15, soil.planes);
  ASSERT_EQ(soil.footings(), 5);
  EXPECT_EQ(soil.nodes_along, 3);
  EXPECT_EQ(soil.nodes_across, 7);
  for (int f = 0; f < 5; ++f) {
    EXPECT_NEAR(soil.x_of(f), 0.3 + 0.6 * f, 1e-12);
    for (int row = 0; row < 7; ++row)
      for (int a = 0; a < 3; ++a) {
        const Vec3 wanted(soil.x_of(f) + 0.15 * (a - 1), 0.15 * row, 0);
        EXPECT_LT((mesh.nodes[static_cast<std::size_t>(soil.node(f, a, row))] - wanted).norm(), 1e-12);
      }
  }
  EXPECT_NEAR(soil.area.sum(), 0.3 * 0.9, 1e-15);
}

TEST(Soil, PressureShapesAreOrthonormalAndHoldEveryTilt) {
  const Soil soil = make_soil(strip_of_soil());
  EXPECT_LT((soil.shapes.transpose() * soil.shape_forces - Eigen::MatrixXd::Identity(6, 6)).norm(), 1e-13);
  Eigen::VectorXd tilt(soil.nodes_per_footing());
  for (int i = 0; i < tilt.size(); ++i) tilt[i] = 1 + 2 * (i % 3) + 3 * (i / 3) + 4 * (i / 3) * (i % 3);
  EXPECT_LT((soil.shapes * (soil.shape_forces.transpose() * tilt) - tilt).norm(), 1e-12 * tilt.norm());

  SoilInput in = strip_of_soil();
  in.whole_width = true;
  const Soil whole = make_soil(in);
  EXPECT_EQ(whole.shapes.cols(), 12);
  EXPECT_NEAR(whole.area.sum(), 2 * soil.area.sum(), 1e-15);
  // A shape and its mirror image press together as the half's shape does on both sides.
  const Eigen::VectorXd both = whole.shape_forces.col(0) + whole.shape_forces.col(6);
  EXPECT_NEAR(both.sum(), 2 * soil.shape_forces.col(0).sum(), 1e-14);
}

TEST(Soil, MassesAreThoseOfTheMesh) {
  for (bool whole : {false, true}) {
    SoilInput in = strip_of_soil();
    in.whole_width = whole;
    const Soil soil = make_soil(in);
    const Eigen::VectorXd m = lumped_node_masses(extrude(soil.section, 0, 0.15, soil.planes), soil.materials);
    for (int p = 0; p < soil.planes; ++p)
      for (int s = 0; s < soil.section_size(); ++s)
        ASSERT_NEAR(soil.mass(p, s), m[p * soil.section_size() + s], 1e-12);
  }
}

TEST(Soil, DashpotsOfAFaceAreItsAreaTimesImpedance) {
  SoilInput in = strip_of_soil();
  in.subgrade = in.ballast;
  in.start = in.base = in.side = Support::absorbing;
  const Soil soil = make_soil(in);
  Vec3 sum = Vec3::Zero();
  for (int p = 0; p < soil.planes; ++p)
    for (int s = 0; s < soil.section_size(); ++s) sum += soil.dashpot(p, s);
  const double end = 0.15 * 0.15 * (3 * 8 + 7 + 6), base = 3 * 1.2, side = 3 * 0.45;
  const double across = in.ballast.density * in.ballast.pressure_wave_speed();
  const double along = in.ballast.density * in.ballast.shear_wave_speed();
  EXPECT_NEAR(sum.x(), end * across + (base + side) * along, 1e-9 * sum.x());
  EXPECT_NEAR(sum.y(), side * across + (base + end) * along, 1e-9 * sum.y());
  EXPECT_NEAR(sum.z(), base * across + (end + side) * along, 1e-9 * sum.z());
}

TEST(Soil, WrongLengthsAreNamed) {
  auto message = [](auto change) -> std::string {
    SoilInput in = strip_of_soil();
    change(in);
    try {
      make_soil(in);
    } catch (const InputError& e) {
      return e.what();
    }
    return "";
  };
  EXPECT_EQ(message([](SoilInput& in) { in.ballast_depth = 0.35; }),
            "ballast_depth is 0.35 m; it must be a multiple of the element size, 0.15 m");
  EXPECT_EQ(message([](SoilInput& in) { in.sleepers = 6; }),
            "6 sleepers 0.6 m apart from 0.3 m do not lie on 3 m of ground");
  EXPECT_NE(message([](SoilInput& in) { in.crest = 0.75; }).find("crest of the ballast, 0.75 m"),
            std::string::npos);
  EXPECT_NE(message([](SoilInput& in) { in.crest = 1.5; }).find("within half_width, 1.2 m"),
            std::string::npos);
  EXPECT_NE(message([](SoilInput& in) { in.element_size = 0; }), "");
}

}  // namespace
}  // namespace trackbed::fem
