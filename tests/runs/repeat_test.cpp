// A wall that moves, once, and again and again.
#include <gtest/gtest.h>

#include "expected.h"
#include "lab/case.h"
#include "lab/run.h"
#include "scenes/scene.h"

namespace trackbed {
namespace {

std::unique_ptr<Stage> stage_of(const std::string& text) {
  const Document document = Document::from_text(text, "case.toml", {});
  CaseInput input;
  document.read(input);
  return input.stages.at(0).input->make(input);
}

constexpr const char* loads = R"toml(
title = "Loads"
[materials.ballast]
kn = "1e7 N/m"
ks = "1e7 N/m"
[[stages]]
kind = "repeat"
times = 3
measures = ["lid.displacement_z"]
  [[stages.stages]]
  kind = "move"
  name = "lower"
  wall = "lid"
  velocity = ["0 m/s", "0 m/s", "-10 mm/s"]
  force = "100 N"
  [[stages.stages]]
  kind = "move"
  name = "raise"
  wall = "lid"
  velocity = ["0 m/s", "0 m/s", "20 mm/s"]
  displacement = "1 mm"
)toml";

/// A ball on a plane under another plane, which just touches it.
Simulation ball_under_lid() {
  scenes::Setting setting;
  setting.damping = 0.7;
  Simulation sim = scenes::make_scene(setting);
  scenes::add_plane(sim, Vec3::Zero(), Vec3::UnitZ());
  const int lid = scenes::add_plane(sim, {0, 0, 0.04}, -Vec3::UnitZ());
  sim.model.walls[static_cast<std::size_t>(lid)].shape.name = "lid";
  scenes::add_ball(sim, {0, 0, 0.02});
  sim.changed();
  return sim;
}

double cell(const ResultTable& table, std::size_t row, const std::string& column) {
  for (std::size_t k = 0; k < table.columns.size(); ++k)
    if (table.columns[k].name == column) return table.rows.at(row).at(k);
  ADD_FAILURE() << "there is no column " << column;
  return 0;
}

// A ball between two planes is a spring of 0.5e6 N/m: mean force over the way from a to b k (a + b)/2.
TEST(Move, MeansOfTheForceOverPartsOfTheWay) {
  Simulation sim = ball_under_lid();
  const auto results = carry_out(sim, *stage_of(R"toml(
title = "Press"
[materials.ballast]
kn = "1e7 N/m"
ks = "1e7 N/m"
[[stages]]
kind = "move"
wall = "lid"
velocity = ["0 m/s", "0 m/s", "-10 mm/s"]
distance = "0.45 mm"
mean_over = "0.1 mm"
)toml"));
  const double peak = value_of(results, "force_peak");
  EXPECT_NEAR(peak, 225, 2);
  EXPECT_NEAR(value_of(results, "mean_force_peak"), 0.5e6 * 0.35e-3, 2);  // the last half part is not whole
  EXPECT_NEAR(value_of(results, "distance_at_mean_peak"), 0.35e-3, 1e-12);
}

// Two contacts of 1e6 N/m in series: 100 N press them together by 0.2 mm.
TEST(Repeat, ALidGoesDownToItsForceAndUpToItsPlaceEachTime) {
  Simulation sim = ball_under_lid();
  const std::unique_ptr<Stage> stage = stage_of(loads);
  const std::vector<Result> results = carry_out(sim, *stage);
  const ResultTable& table = *stage->table();
  ASSERT_EQ(table.rows.size(), 3u);
  for (std::size_t k = 0; k < 3; ++k) {
    EXPECT_EQ(cell(table, k, "number"), static_cast<double>(k + 1));
    EXPECT_NEAR(cell(table, k, "lower.force"), 100, 2);
    EXPECT_NEAR(cell(table, k, "lower.lid.displacement_z"), -0.2e-3, 0.006e-3);
    EXPECT_NEAR(cell(table, k, "raise.lid.displacement_z"), 1e-3, 0.006e-3);
  }
  EXPECT_NEAR(cell(table, 0, "lower.distance"), 0.2e-3, 0.006e-3);
  EXPECT_NEAR(cell(table, 1, "lower.distance"), 1.2e-3, 0.012e-3);
  // As results: the last time.
  EXPECT_EQ(results.front().name, "times");
  EXPECT_EQ(results.front().value, 3);
  bool found = false;
  for (const Result& r : results)
    if (r.name == "lower.distance") {
      EXPECT_EQ(r.value, cell(table, 2, "lower.distance"));
      EXPECT_EQ(r.dimension, Dimension::length);
      found = true;
    }
  EXPECT_TRUE(found);
}

TEST(Repeat, WhatAStageChangesIsBroughtBackBeforeTheNext) {
  Simulation sim = ball_under_lid();
  const std::unique_ptr<Stage> stage = stage_of(R"toml(
title = "Raised gravity"
[materials.ballast]
kn = "1e7 N/m"
ks = "1e7 N/m"
[[stages]]
kind = "repeat"
times = 2
  [[stages.stages]]
  kind = "settle"
  gravity = "50 m/s^2"
  unbalanced_ratio = 0.5
  [[stages.stages]]
  kind = "hold"
  duration = "1 ms"
)toml");
  sim.model.gravity = {0, 0, -9.81};
  stage->open(sim);
  bool was_raised = false, held_in_own = false;
  while (!stage->finished(sim)) {
    stage->control(sim);
    const double g = sim.model.gravity.norm();
    was_raised = was_raised || g == 50;
    held_in_own = held_in_own || g == 9.81;
    sim.step();
  }
  stage->close(sim);
  EXPECT_TRUE(was_raised);
  EXPECT_TRUE(held_in_own);
  EXPECT_EQ(sim.model.gravity.norm(), 9.81);
}

}  // namespace
}  // namespace trackbed
