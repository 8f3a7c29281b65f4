// Levels of force that a moving wall crosses, by themselves and in the stage `move`.
#include "lab/stages/levels.h"

#include <gtest/gtest.h>

#include "base/error.h"
#include "io/files.h"
#include "lab/case.h"
#include "lab/run.h"
#include "lab/track/sleeper_peaks.h"
#include "scenes/scene.h"
#include "scenes/temporary_folder.h"

namespace trackbed {
namespace {

Simulation ball_on_plane() {
  Simulation sim = scenes::make_scene({});
  scenes::add_plane(sim, Vec3::Zero(), Vec3::UnitZ());
  scenes::add_ball(sim, {0, 0, 0.0199});
  sim.changed();
  return sim;
}

TEST(Levels, FirstCrossingsAreNotedOnceAndInOrder) {
  const Simulation sim = ball_on_plane();
  LevelsInput in;
  in.levels = {100, 150, 200, 1000};
  in.measures = {"contacts", "plane.force_z"};
  Levels levels(in);
  levels.open(sim);
  levels.look(sim, 90, 0.1);
  EXPECT_TRUE(levels.table()->rows.empty());
  levels.look(sim, 160, 0.2);  // two at once
  levels.look(sim, 50, 0.3);
  levels.look(sim, 170, 0.4);  // 150 was crossed before
  levels.look(sim, 200, 0.5);
  EXPECT_FALSE(levels.all_crossed());
  const ResultTable& table = *levels.table();
  ASSERT_EQ(table.columns.size(), 6u);
  EXPECT_EQ(table.columns[4].name, "contacts");
  EXPECT_EQ(table.columns[5].dimension, Dimension::force);
  ASSERT_EQ(table.rows.size(), 3u);
  for (std::size_t k = 0; k < 3; ++k) {
    EXPECT_EQ(table.rows[k][0], in.levels[k]);
    EXPECT_EQ(table.rows[k][4], 1);
    EXPECT_NEAR(table.rows[k][5], -100, 1e-9);
  }
  EXPECT_EQ(table.rows[1][1], 160);
  EXPECT_EQ(table.rows[1][2], 0.2);
  const std::vector<Result> results = levels.results();
  ASSERT_EQ(results.size(), 3u);
  EXPECT_EQ(results[1].name, "distance_at_0.15_kN");
  EXPECT_EQ(results[2].value, 0.5);

  Archive writing;
  levels.archive(writing);
  Levels again(in);
  Archive reading(writing.bytes());
  again.archive(reading);
  again.look(sim, 1e4, 0.7);
  EXPECT_TRUE(again.all_crossed());
  EXPECT_EQ(again.table()->rows.size(), 4u);
}

TEST(Levels, WithoutLevelsThereIsNoTableAndNoEnd) {
  const Simulation sim = ball_on_plane();
  Levels none((LevelsInput()));
  none.open(sim);
  none.look(sim, 1e9, 1);
  EXPECT_EQ(none.table(), nullptr);
  EXPECT_FALSE(none.all_crossed());
}

constexpr const char* passage =
    "number [-],zone,x [m],peak_force [N]\n-2,approach,1,90000\n-1,approach,2,80000\n0,bridge,3,0\n"
    "1,departure,4,120000\n7,run_out,5,1\n";

TEST(Levels, ComeFromThePassageOfATrain) {
  const TemporaryFolder folder;
  write_file(folder.path / "sleepers.csv", passage);
  LevelsInput in;
  in.from_track = folder.path;
  Levels levels(in);
  const Simulation sim = ball_on_plane();
  levels.open(sim);
  levels.look(sim, 1e5, 0.1);
  ASSERT_EQ(levels.table()->rows.size(), 2u);
  EXPECT_EQ(levels.table()->columns[1].name, "sleeper");
  EXPECT_EQ(levels.table()->rows[0][1], -1);  // by force, not by place
  EXPECT_EQ(levels.table()->rows[1][1], -2);
  EXPECT_EQ(levels.results()[0].name, "distance_at_sleeper_-1");
  levels.look(sim, 1.3e5, 0.2);
  EXPECT_TRUE(levels.all_crossed());
  EXPECT_EQ(levels.results()[2].name, "distance_at_sleeper_+1");

  in.sleepers = {1};
  EXPECT_EQ(read_peaks(*in.from_track, in.sleepers).at(0).force, 120000);
  EXPECT_EQ(read_peaks(folder.path / "sleepers.csv").size(), 3u);
}

TEST(Levels, WhatIsNoResultOfATrackIsRefused) {
  const TemporaryFolder folder;
  const auto message = [&](const char* text, const std::vector<double>& sleepers = {}) -> std::string {
    if (text) write_file(folder.path / "sleepers.csv", text);
    try {
      read_peaks(folder.path, sleepers);
    } catch (const InputError& error) {
      return error.what();
    }
    return "nothing wrong";
  };
  EXPECT_NE(message(nullptr).find("no results of a track case: there is no sleepers.csv"), std::string::npos);
  EXPECT_NE(message("a [N],zone\n1,x\n").find("lacks a column number, zone or peak_force"),
            std::string::npos);
  EXPECT_NE(message("number,zone,peak_force\n0,bridge,0\n").find("there are no sleepers on ballast"),
            std::string::npos);
  EXPECT_NE(message(passage, {3}).find("there is no sleeper 3 on ballast"), std::string::npos);
}

/// A ball between the floor and a lid that comes down.
class Press : public ::testing::Test {
 protected:
  Press() {
    scenes::Setting a;
    a.damping = 0.7;
    sim_ = scenes::make_scene(a);
    scenes::add_plane(sim_, Vec3::Zero(), Vec3::UnitZ());
    lid_ = static_cast<std::size_t>(
        add_wall(sim_, {make_plane_wall("lid", 1.0), 0, {}},
                 {Vec3(0, 0, 0.0401), Quat::FromTwoVectors(Vec3::UnitZ(), -Vec3::UnitZ())}));
    scenes::add_ball(sim_, {0, 0, 0.02});
    sim_.changed();
  }
  std::unique_ptr<Stage> stage(const std::string& keys) const {
    const Document document = Document::from_text(R"(title = "press"
materials.ballast = { kn = "1e6 N/m", ks = "1e6 N/m" }
[[stages]]
kind = "move"
wall = "lid"
velocity = ["0 m/s", "0 m/s", "-1 mm/s"]
)" + keys,
                                                  "press.toml");
    CaseInput in;
    document.read(in);
    return in.stages.at(0).input->make(in);
  }
  Simulation sim_;
  std::size_t lid_ = 0;
};

// Two contacts of 1e6 N/m in a row: 5e5 N/m from the first touch on.
TEST_F(Press, TheForceGrowsAlongALine) {
  const auto move = stage("levels = [\"50 N\", \"100 N\", \"200 N\"]\nmeasures = [\"lid.contacts\"]\n");
  const std::vector<Result> results = carry_out(sim_, *move);
  const ResultTable& table = *move->table();
  ASSERT_EQ(table.rows.size(), 3u);
  for (const auto& row : table.rows) {
    EXPECT_NEAR(row[2], 0.1e-3 + row[0] / 5e5, 0.01 * row[0] / 5e5);
    EXPECT_GE(row[1], row[0]);
    EXPECT_LT(row[1], 1.01 * row[0]);
    EXPECT_EQ(row[4], 1);
  }
  EXPECT_EQ(results.back().name, "distance_at_0.2_kN");
  // It ends where the last level was crossed, not a step later.
  EXPECT_EQ(0.0401 - sim_.state.walls[lid_].pose.position.z(), table.rows.back()[2]);
}

TEST_F(Press, LevelsBeyondTheEndOfTheMotionHaveNoRows) {
  const auto move = stage("levels = [\"50 N\", \"100 N\"]\nforce = \"60 N\"\n");
  carry_out(sim_, *move);
  EXPECT_EQ(move->table()->rows.size(), 1u);
}

}  // namespace
}  // namespace trackbed
