#include "lab/influence.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>

#include "base/error.h"
#include "lab/case.h"
#include "scenes/temporary_folder.h"

namespace trackbed {
namespace {

InfluenceField some_field() {
  InfluenceField field;
  field.name = "displacement";
  field.dimension = Dimension::length;
  for (int k = 0; k < 10; ++k) {
    field.places.push_back({0.1 * k, 0.2, 0.3});
    field.values.push_back(0.001 * ((7 * k) % 10));
  }
  return field;
}

TEST(Influence, TheThresholdLeavesTheAskedShareAbove) {
  const InfluenceField field = some_field();
  for (const int above : {0, 1, 3, 9, 10}) {
    const double limit = threshold_for(field, 0.1 * above);
    EXPECT_EQ(std::ranges::count_if(field.values, [&](double v) { return v > limit; }), above);
  }
}

// The region of the case that follows holds just the stones above the threshold.
TEST(Influence, ARegionReadsBackWhatWasWritten) {
  const TemporaryFolder folder;
  const InfluenceField field = some_field();
  write_influence(field, folder.path / "influence.csv");
  const double limit = threshold_for(field, 0.3);
  const Document document = Document::from_text(fmt::format(R"toml(
title = "area"
[materials.ballast]
kn = "1e7 N/m"
ks = "1e7 N/m"
[regions.area]
kind = "field"
file = "influence.csv"
above = {:.17g}
[[stages]]
kind = "hold"
duration = "1 s"
)toml",
                                                            limit),
                                                folder.path / "case.toml", {});
  CaseInput input;
  document.read(input);
  const Region area = input.regions.at("area").input->make();
  for (std::size_t k = 0; k < field.places.size(); ++k)
    EXPECT_EQ(area(field.places[k]), field.values[k] > limit) << k;
}

TEST(Influence, IsReadFromAStonesTable) {
  const TemporaryFolder folder;
  const auto path = folder.path / "stones.csv";
  std::ofstream(path) << "id [-],x [m],y [m],z [m],mean_stress [Pa],displacement_x [m],displacement_y "
                         "[m],displacement_z [m]\n0,1,2,3,50,0.3,0,-0.4\n1,4,5,6,70,0,0,0\n";
  const InfluenceField moved = read_influence(path, "displacement");
  ASSERT_EQ(moved.values.size(), 2u);
  EXPECT_DOUBLE_EQ(moved.values[0], 0.5);
  EXPECT_TRUE(moved.places[0].isApprox(Vec3(0.7, 2, 3.4)));
  EXPECT_DOUBLE_EQ(read_influence(path, "mean_stress").values[1], 70);

  std::ofstream(path) << "id [-],x [m],y [m],z [m]\n";
  EXPECT_THROW(read_influence(path, "displacement"), InputError);
  std::ofstream(path) << "x [m],y [m],z [m],displacement_x [m],displacement_y [m],displacement_z [m]\n1,2\n";
  EXPECT_THROW(read_influence(path, "displacement"), InputError);
}

}  // namespace
}  // namespace trackbed
