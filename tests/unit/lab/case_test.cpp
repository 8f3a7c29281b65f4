#include "lab/case.h"

#include <gtest/gtest.h>

namespace trackbed {
namespace {

Simulation simulation_with(const std::vector<std::string>& set) {
  const Document document = Document::from_text(R"toml(
title = "Two stones"
stones = { shapes = 2, distance = "120 deg", ratio = 0.5 }
materials.ballast = { kn = "1e6 N/m", ks = "1e6 N/m", density = "2650 kg/m^3" }
[[stages]]
kind = "settle"
)toml",
                                                "case.toml", set);
  CaseInput experiment;
  document.read(experiment);
  return make_simulation(document, experiment);
}

TEST(Case, ShapesHaveASeedOfTheirOwnWhereOneIsGiven) {
  const auto inertia = [](const std::vector<std::string>& set) {
    return simulation_with(set).model.templates.at(1).inertia;
  };
  EXPECT_NE(inertia({"seed=1"}), inertia({"seed=2"}));
  EXPECT_EQ(inertia({"seed=1", "stones.seed=5"}), inertia({"seed=2", "stones.seed=5"}));
  EXPECT_EQ(inertia({"seed=5"}), inertia({"seed=2", "stones.seed=5"}));
}

}  // namespace
}  // namespace trackbed
