// trackbed study as a user calls it: it goes on after any end, and its tables do not tell.
#include <gtest/gtest.h>
#include <signal.h>

#include <chrono>
#include <cstdlib>
#include <filesystem>
#include <string>
#include <thread>

#include "base/rng.h"
#include "io/files.h"
#include "scenes/study_process.h"
#include "scenes/temporary_folder.h"

namespace trackbed {
namespace {

namespace fs = std::filesystem;

constexpr const char* study = R"toml(
title = "Friction of balls"
case = "case.toml"
repeats = 3
measures = ["porosity", "contacts"]
[[sweep]]
key = "materials.ballast.friction"
values = ["0.1", "0.5"]
)toml";

class StudyCommand : public testing::Test {
 protected:
  void SetUp() override {
    write_file(folder_.path / "case.toml", balls_in_a_box);
    write_file(folder_.path / "study.toml", study);
  }

  int run(const std::string& out, std::vector<std::string> options = {}) const {
    options.insert(options.end(), {"--jobs", "2"});
    return StudyProcess(TRACKBED_PROGRAM, folder_.path / "study.toml", folder_.path / out, options).wait();
  }
  std::string messages() const { return read_file(folder_.path / "messages.txt"); }

  void expect_the_same_when_killed(int kills, int longest_ms);

  TemporaryFolder folder_;
};

/// Kills a worker and the study by turns, so many times together, at moments up to longest_ms apart.
void StudyCommand::expect_the_same_when_killed(int kills, int longest_ms) {
  const fs::path calm = folder_.path / "calm", killed = folder_.path / "killed";
  ASSERT_EQ(run("calm"), 0) << messages();
  Rng rng(1, "whom to kill, and when");
  int done = 0;
  for (int studies = 0; done < kills && studies < 10 * kills; ++studies) {
    // What three kills have stopped is given up: it is tried again.
    StudyProcess study_process(TRACKBED_PROGRAM, folder_.path / "study.toml", killed,
                               {"--jobs", "2", "--retry"});
    while (done < kills && !study_process.has_ended()) {
      std::this_thread::sleep_for(
          std::chrono::milliseconds(1 + rng.index(static_cast<std::uint64_t>(longest_ms))));
      const std::vector<pid_t> workers = study_process.workers();
      if (done % 2 == 0) {
        if (!workers.empty() && ::kill(workers[rng.index(workers.size())], SIGKILL) == 0) ++done;
      } else if (!study_process.has_ended()) {
        study_process.kill();
        ++done;
      }
    }
    study_process.wait();
    // All members done before all kills: from the beginning again.
    if (done < kills && fs::exists(killed / "study.csv") && members_of(killed) == members_of(calm))
      fs::remove_all(killed);
  }
  EXPECT_EQ(done, kills);
  EXPECT_EQ(run("killed", {"--retry"}), 0) << messages();
  EXPECT_EQ(members_of(killed), members_of(calm));
  EXPECT_EQ(read_file(killed / "table.csv"), read_file(calm / "table.csv"));
}

TEST_F(StudyCommand, IsTheSameHoweverOftenItAndItsWorkersAreKilled) {
  expect_the_same_when_killed(6, 300);
}

TEST_F(StudyCommand, long_is_the_same_after_twenty_kills) {
  expect_the_same_when_killed(20, 600);
}

TEST_F(StudyCommand, AStoppedMemberGoesOnFromItsOwnCheckpoint) {
  // Long enough to be stopped on the way: the study asks its members to stop, and each leaves a checkpoint.
  const std::vector<std::string> options{"--set", "stages.settle.unbalanced_ratio=1e-6", "--repeats", "1"};
  ASSERT_EQ(run("calm", options), 0) << messages();
  StudyProcess stopped(TRACKBED_PROGRAM, folder_.path / "study.toml", folder_.path / "out", options);
  const fs::path members = folder_.path / "out/members";
  const auto begun = [&] {
    return !expand_pattern(members / "*/checkpoint/*.state").empty();  // the first stage is over
  };
  while (!begun() && !stopped.has_ended()) std::this_thread::sleep_for(std::chrono::milliseconds(1));
  stopped.ask_to_stop();
  stopped.wait();
  ASSERT_FALSE(expand_pattern(members / "*/checkpoint/*.state").empty());
  ASSERT_EQ(run("out", options), 0) << messages();
  EXPECT_EQ(members_of(folder_.path / "out"), members_of(folder_.path / "calm"));
}

TEST_F(StudyCommand, RunsAgainOnlyWhatHasChanged) {
  ASSERT_EQ(run("out"), 0) << messages();
  const auto when = [&](const char* member) {
    return fs::last_write_time(folder_.path / "out/members" / member / "summary.json");
  };
  const auto first = when("friction_0.1-seed-1");
  std::string changed = study;
  changed.replace(changed.find("\"0.5\""), 5, "\"0.6\"");
  write_file(folder_.path / "study.toml", changed);
  ASSERT_EQ(run("out"), 0) << messages();
  EXPECT_EQ(when("friction_0.1-seed-1"), first);
  EXPECT_TRUE(fs::exists(folder_.path / "out/members/friction_0.6-seed-3/summary.json"));
  EXPECT_NE(messages().find("6 members: 3 done, 0 failed, 3 to run"), std::string::npos) << messages();

  write_file(folder_.path / "study.toml",
             changed + "\n[[conditions]]\nname = \"deep\"\nset = [\"stages.fill.porosity=0.5\"]\n");
  ASSERT_EQ(run("out"), 0) << messages();
}

TEST_F(StudyCommand, SaysThatTheCaseWasChangedWhileItRan) {
  StudyProcess running(TRACKBED_PROGRAM, folder_.path / "study.toml", folder_.path / "out", {"--jobs", "1"});
  while (!fs::exists(folder_.path / "out/members") && !running.has_ended())
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  std::string changed = balls_in_a_box;
  changed.replace(changed.find("\"0.1 m\""), 7, "\"0.12 m\"");
  write_file(folder_.path / "case.toml", changed);
  EXPECT_EQ(running.wait(), 1);
  EXPECT_NE(messages().find("its case was changed while the study ran (walls.box.size"), std::string::npos)
      << messages();
}

TEST_F(StudyCommand, ABadMemberIsNamedAndTheOthersGoOn) {
  std::string with_bad = study;
  with_bad.replace(with_bad.find("values = [\"0.1\", \"0.5\"]"), 24, "values = [\"0.5\"]");
  write_file(folder_.path / "study.toml", with_bad + R"toml(
[[conditions]]
name = "good"
[[conditions]]
name = "hasty"
set = ["stages.settle.time_limit=1 ms"]
)toml");
  EXPECT_EQ(run("out"), 1);
  const std::string rows = read_file(folder_.path / "out/study.csv");
  EXPECT_NE(
      rows.find(
          "hasty_friction_0.5-seed-1,\"hasty, friction 0.5\",0.5,1 ms,1,failed,\"exit 1: trackbed: stage "
          "settle: not at rest after 0.001 s"),
      std::string::npos)
      << rows;
  EXPECT_NE(rows.find("good_friction_0.5-seed-3,\"good, friction 0.5\",0.5,,3,done,,"), std::string::npos)
      << rows;
  EXPECT_EQ(run("out"), 1);  // failures are remembered
  EXPECT_NE(messages().find("3 done, 3 failed, 0 to run"), std::string::npos) << messages();
}

TEST_F(StudyCommand, AddsSeedsUntilTheIntervalIsNarrow) {
  EXPECT_EQ(run("out", {"--repeat-until", "contacts < 0.1 %", "--most-repeats", "5"}), 0) << messages();
  EXPECT_TRUE(fs::exists(folder_.path / "out/members/friction_0.5-seed-5/summary.json"));
  EXPECT_FALSE(fs::exists(folder_.path / "out/members/friction_0.5-seed-6"));
  // The same command goes on with the seeds that it had added.
  fs::remove_all(folder_.path / "out/members/friction_0.5-seed-5");
  EXPECT_EQ(run("out", {"--repeat-until", "contacts < 0.1 %", "--most-repeats", "5"}), 0) << messages();
  EXPECT_TRUE(fs::exists(folder_.path / "out/members/friction_0.5-seed-5/summary.json"));
  EXPECT_EQ(run("wide", {"--repeat-until", "contacts < 100 %"}), 0) << messages();
  EXPECT_FALSE(fs::exists(folder_.path / "wide/members/friction_0.5-seed-4"));
  EXPECT_EQ(run("wrong", {"--repeat-until", "contacts"}), 2);
}

// Members are called with the whole path of the case; files that it names lie beside it all the same.
TEST_F(StudyCommand, MayBeNamedFromWhereOneStands) {
  fs::copy_file(fs::path(TRACKBED_ROOT) / "tests/input/case/inward.obj", folder_.path / "cube.obj");
  write_file(folder_.path / "case.toml",
             std::string(balls_in_a_box) + "\n[regions.cube]\nkind = \"mesh\"\nfile = \"cube.obj\"\n");
  const fs::path before = fs::current_path();
  fs::current_path(folder_.path);
  const int code = StudyProcess(TRACKBED_PROGRAM, "study.toml", "out", {"--repeats", "1"}).wait();
  fs::current_path(before);
  EXPECT_EQ(code, 0) << messages();
}

TEST_F(StudyCommand, ChangesTheCaseInAllMembersButNotWhatTheStudyChanges) {
  EXPECT_EQ(run("out", {"--repeats", "1", "--set", "stages.fill.porosity=0.6"}), 0) << messages();
  const std::string summary = read_file(folder_.path / "out/members/friction_0.5-seed-1/summary.json");
  EXPECT_NE(summary.find("\"porosity\": 0.6"), std::string::npos) << summary;
  EXPECT_FALSE(fs::exists(folder_.path / "out/members/friction_0.5-seed-2"));
  EXPECT_EQ(run("out", {"--set", "materials.ballast.friction=0.3"}), 2);
  EXPECT_NE(messages().find("the study itself changes materials.ballast.friction"), std::string::npos);
  EXPECT_EQ(run("out", {"--set", "seed=3"}), 2);
}

TEST_F(StudyCommand, SaysThatThereIsNoSlurm) {
  EXPECT_EQ(run("out", {"--sbatch=--mem=1G"}), 2);
  EXPECT_NE(messages().find("--sbatch is for --on slurm only"), std::string::npos) << messages();
  const std::string path = std::getenv("PATH");
  ::setenv("PATH", folder_.path.c_str(), 1);
  EXPECT_EQ(run("out", {"--on", "slurm"}), 2);
  ::setenv("PATH", path.c_str(), 1);
  EXPECT_NE(messages().find("--on slurm: there is no sbatch on this machine"), std::string::npos)
      << messages();
}

}  // namespace
}  // namespace trackbed
