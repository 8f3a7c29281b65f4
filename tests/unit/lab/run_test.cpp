// What a run writes, with stages of the test's own.
#include "lab/run.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <limits>
#include <sstream>

#include "base/error.h"
#include "io/files.h"
#include "scenes/scene.h"
#include "scenes/temporary_folder.h"

namespace trackbed {
namespace {

namespace fs = std::filesystem;

class Run : public ::testing::Test {
 protected:
  void SetUp() override {
    scenes::Setting setting;
    setting.gravity = {0, 0, -9.81};
    setting.damping = 0.7;
    setting.dt = 1e-5;
    sim_ = scenes::make_scene(setting);
    scenes::add_plane(sim_, Vec3::Zero(), Vec3::UnitZ());
    scenes::add_ball(sim_, {0, 0, 0.02});
    sim_.changed();
    summary_.title = "one ball";
    summary_.force_limits = {0.1, 10};
    record_.every = 1e-3;
    record_.measures = {"weight"};
  }

  void run(std::vector<NamedStage> stages) {
    Recorder recorder(sim_, record_, out_);
    run_stages(sim_, stages, recorder, {.out = out_, .threads = 1, .quiet = true, .progress = nullptr},
               summary_);
  }
  std::vector<std::string> lines(const fs::path& file) const {
    std::istringstream text(read_file(out_ / file));
    std::vector<std::string> all;
    for (std::string line; std::getline(text, line);) all.push_back(line);
    return all;
  }

  TemporaryFolder folder_;
  fs::path out_ = folder_.path;
  Simulation sim_;
  RecordInput record_;
  Summary summary_;
};

class Steps : public Stage {
 public:
  explicit Steps(int steps, double stones = 0) : left_(steps), stones_(stones) {}
  void open(Simulation&) override {}
  void control(Simulation&) override { --left_; }
  bool finished(const Simulation&) override { return left_ == 0; }
  void archive(Archive& a) override { a(left_, stones_); }
  std::vector<Result> close(Simulation&) override {
    return {{"answer", 42, Dimension::force}, {"added", stones_}};
  }

 private:
  int left_;
  double stones_;
};

/// Keeps a row of time and force a step; the last after its last step.
class Tells : public Steps {
 public:
  explicit Tells(int steps) : Steps(steps) {}
  void control(Simulation& sim) override {
    Steps::control(sim);
    add(sim);
  }
  std::vector<Result> close(Simulation& sim) override {
    add(sim);
    return {};
  }
  const ResultTable* table() const override { return &table_; }
  void archive(Archive& a) override {
    Steps::archive(a);
    a(table_);
  }

 private:
  void add(const Simulation& sim) { table_.rows.push_back({sim.state.time, 2.5}); }
  ResultTable table_{"course", {{"time", Dimension::time}, {"force", Dimension::force}}, {}};
};

/// Makes the ball's speed a thing that is not a number.
class Breaks : public Steps {
 public:
  Breaks() : Steps(1000) {}
  void control(Simulation& sim) override {
    Steps::control(sim);
    sim.state.clumps.velocity[0].x() = std::numeric_limits<double>::quiet_NaN();
  }
};

NamedStage steps(const std::string& name, int n, double stones = 0) {
  return {name, "hold", std::make_unique<Steps>(n, stones)};
}

std::vector<NamedStage> list(NamedStage a) {
  std::vector<NamedStage> all;
  all.push_back(std::move(a));
  return all;
}

TEST_F(Run, SeriesHasARowAtEachTimeAndStageEndAndNoneTwice) {
  std::vector<NamedStage> stages = list(steps("drop", 250));  // 2.5 ms: rows at 1, 2 and 2.5 ms
  stages.push_back(steps("rest", 50));                        // to 3 ms: one row, due and end at once
  run(std::move(stages));
  const std::vector<std::string> rows = lines("series.csv");
  ASSERT_EQ(rows.size(), 5u);
  EXPECT_TRUE(rows[0].starts_with(
      "time [s],stage,step [-],dt [s],contacts [-],energy_kinetic [J],energy_total [J],plane.force_x [N],"));
  EXPECT_TRUE(rows[0].ends_with(",weight [N]"));
  EXPECT_NE(rows[1].find(",drop,100,1e-05,"), std::string::npos) << rows[1];
  EXPECT_NE(rows[3].find(",drop,250,"), std::string::npos) << rows[3];
  EXPECT_NE(rows[4].find(",rest,300,"), std::string::npos) << rows[4];
}

TEST_F(Run, TablesTellOfEveryContactAndStone) {
  run(list(steps("drop", 5000)));
  const std::vector<std::string> contacts = lines("contacts.csv"), stones = lines("stages/drop-stones.csv");
  ASSERT_EQ(contacts.size(), 2u);
  EXPECT_TRUE(contacts[1].starts_with("0,0,-1,plane,")) << contacts[1];
  ASSERT_EQ(stones.size(), 2u);
  EXPECT_TRUE(stones[1].starts_with("0,ball,0.0888")) << stones[1];
  EXPECT_EQ(lines("contacts.csv"), lines("stages/drop-contacts.csv"));
  for (const char* file : {"bed.png", "forces.png", "displacements.png", "paraview/stones.pvd",
                           "paraview/contacts.pvd", "paraview/walls.pvd", "paraview/frames/stones-00000.vtp"})
    EXPECT_TRUE(fs::exists(out_ / file)) << file;
}

TEST_F(Run, OnlyTheStagesAskedForLeaveTablesAndPictures) {
  record_.stages = {"rest"};
  std::vector<NamedStage> stages = list(steps("drop", 250));
  stages.push_back(steps("rest", 50));
  run(std::move(stages));
  for (const char* file : {"contacts.csv", "stones.csv", "bed.png", "forces.png", "displacements.png"}) {
    EXPECT_FALSE(fs::exists(out_ / "stages" / fmt::format("drop-{}", file))) << file;
    EXPECT_TRUE(fs::exists(out_ / "stages" / fmt::format("rest-{}", file))) << file;
    EXPECT_TRUE(fs::exists(out_ / file)) << file;
  }
}

TEST_F(Run, TheTableOfAStageIsWrittenWithTheRowOfItsEnd) {
  record_.stages = {"another"};  // a table is a result: written whatever else is
  run(list({"tell all", "hold", std::make_unique<Tells>(2)}));
  EXPECT_EQ(lines("stages/tell_all-course.csv"),
            (std::vector<std::string>{"time [s],force [N]", "0,2.5", "1e-05,2.5", "2e-05,2.5"}));
}

TEST(ResultTables, ComeBackFromAnArchive) {
  ResultTable table{"levels", {{"force", Dimension::force}, {"share"}}, {{1, 2}, {3, 4}}};
  Archive writing;
  writing(table);
  Archive reading(writing.bytes());
  ResultTable back;
  reading(back);
  EXPECT_EQ(back.name, "levels");
  ASSERT_EQ(back.columns.size(), 2u);
  EXPECT_EQ(back.columns[0].name, "force");
  EXPECT_EQ(back.columns[0].dimension, Dimension::force);
  EXPECT_EQ(back.rows, table.rows);
}

TEST_F(Run, SummaryHoldsStagesMeasuresAndHash) {
  run(list(steps("drop", 5000)));
  const nlohmann::ordered_json json = to_json(summary_);
  EXPECT_EQ(json["title"], "one ball");
  EXPECT_EQ(json["stages"][0]["name"], "drop");
  EXPECT_EQ(json["stages"][0]["steps"], 5000);
  EXPECT_NEAR(json["stages"][0]["simulated_s"], 0.05, 1e-12);
  EXPECT_EQ(json["stages"][0]["measures"]["coordination_number"]["value"], 1);
  EXPECT_EQ(json["measures"]["drop.answer"]["value"], 42);
  EXPECT_EQ(json["measures"]["drop.answer"]["unit"], "N");
  EXPECT_NEAR(json["measures"]["plane.force_z"]["value"], -0.0888023523 * 9.81, 1e-5);
  EXPECT_EQ(json["force_histogram"]["counts"], (std::vector<int>{0, 1, 0}));
  EXPECT_EQ(json["state_hash"], hash_text(hash(sim_.state)));
  // Second order in the step, a thirtieth of sqrt(m/k).
  EXPECT_LT(std::abs(summary_.stages[0].energy_error), 1e-3 * energy_of(sim_.model, sim_.state).damping_loss);
}

TEST_F(Run, AFailureNamesTheStageAndLeavesTheLastState) {
  try {
    run(list({"blow up", "hold", std::make_unique<Breaks>()}));
    FAIL() << "the run went on with numbers that are none";
  } catch (const RunError& error) {
    const std::string message = error.what();
    EXPECT_TRUE(message.starts_with("stage blow up: stone 0 at (")) << message;
    EXPECT_NE(message.find("the last state is in " + (out_ / "failure").string()), std::string::npos)
        << message;
  }
  EXPECT_EQ(lines("failure/stones.csv").size(), 2u);
  EXPECT_TRUE(fs::exists(out_ / "failure/contacts.csv"));
  EXPECT_TRUE(fs::exists(out_ / "failure/paraview/stones.pvd"));
}

TEST_F(Run, StonesThatNobodyMadeStopTheRun) {
  try {
    run(list(steps("fill", 1, 3)));
    FAIL() << "three stones are missing";
  } catch (const RunError& error) {
    EXPECT_TRUE(
        std::string(error.what()).starts_with("stage fill: there are 1 stones at the end, 4 should be there"))
        << error.what();
  }
}

TEST_F(Run, AnUnknownMeasureIsRefusedWithTheNearest) {
  record_.measures = {"porosty"};
  sim_.container = {Vec3(0, 0, 0), Vec3(1, 1, 1)};
  try {
    Recorder recorder(sim_, record_, out_);
    FAIL() << "there is no such measure";
  } catch (const InputError& error) {
    const std::string message = error.what();
    EXPECT_NE(message.find("there is no measure called porosty"), std::string::npos) << message;
    EXPECT_NE(message.find("did you mean porosity?"), std::string::npos) << message;
  }
}

TEST(FileNames, KeepLettersAndDigits) {
  EXPECT_EQ(file_name_of("load 5 kN/m"), "load_5_kN_m");
  EXPECT_EQ(file_name_of("rest-2.5"), "rest-2.5");
}

}  // namespace
}  // namespace trackbed
