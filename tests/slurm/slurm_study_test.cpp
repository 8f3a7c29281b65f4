// trackbed study --on slurm beside a Slurm that scripts/slurm/with-slurm.sh has started: whatever happens to
// members and to the study, it ends, and says what happened.
#include <gtest/gtest.h>
#include <unistd.h>

#include <chrono>
#include <cstdlib>
#include <filesystem>
#include <functional>
#include <nlohmann/json.hpp>
#include <thread>

#include "io/files.h"
#include "scenes/study_process.h"
#include "scenes/temporary_folder.h"

namespace trackbed {
namespace {

namespace fs = std::filesystem;

int shell(const std::string& command) {
  return std::system((command + " > /dev/null 2>&1").c_str());
}

bool comes_true(const std::function<bool()>& what) {
  for (int tries = 0; tries < 600; ++tries) {
    if (what()) return true;
    std::this_thread::sleep_for(std::chrono::milliseconds(100));
  }
  return false;
}

class SlurmStudy : public testing::Test {
 protected:
  void SetUp() override {
    if (!std::getenv("TRACKBED_SLURM")) GTEST_SKIP() << "there is no Slurm: scripts/slurm/with-slurm.sh";
    write_file(folder_.path / "case.toml", balls_in_a_box);
    write_study("");
  }
  void TearDown() override {
    shell("scancel --user=$(id -un)");
    comes_true([] { return shell("squeue --noheader --me | grep .") != 0; });
  }
  void write_study(const std::string& further) const {
    write_file(
        folder_.path / "study.toml",
        "title = \"Slurm\"\ncase = \"case.toml\"\nrepeats = 2\nmeasures = [\"porosity\", \"contacts\"]\n" +
            further);
  }
  /// Conditions that end well, that fail, and that go on for minutes.
  void write_study_of(const std::vector<std::string>& kinds) const {
    std::string text;
    for (const std::string& kind : kinds) {
      text += "[[conditions]]\nname = \"" + kind + "\"\n";
      if (kind == "bad") text += "set = [\"stages.settle.time_limit=1 ms\"]\n";
      if (kind == "endless")
        text += "set = [\"stages.settle.time_limit=1000 s\", \"stages.settle.unbalanced_ratio=1e-300\"]\n";
    }
    write_study(text);
  }
  [[nodiscard]] StudyProcess start(const std::string& out, std::vector<std::string> options = {}) const {
    options.insert(options.end(), {"--on", "slurm"});
    return {TRACKBED_PROGRAM, folder_.path / "study.toml", folder_.path / out, options};
  }
  int run(const std::string& out, const std::vector<std::string>& options = {}) const {
    return start(out, options).wait();
  }
  int run_here(const std::string& out) const {
    return StudyProcess(TRACKBED_PROGRAM, folder_.path / "study.toml", folder_.path / out).wait();
  }
  std::string messages() const { return read_file(folder_.path / "messages.txt"); }
  std::string rows(const std::string& out) const { return read_file(folder_.path / out / "study.csv"); }
  bool has_begun(const std::string& out, const std::string& member) const {
    return fs::exists(folder_.path / out / "members" / member / "log.txt");
  }
  /// Number of the only job, as the study wrote it down.
  std::string job_of(const std::string& out) const {
    for (const auto& array : fs::directory_iterator(folder_.path / out / "slurm"))
      return nlohmann::json::parse(read_file(array.path() / "members.json"))["job"];
    return "";
  }
  int jobs(const std::string& out) const {
    return static_cast<int>(std::distance(fs::directory_iterator(folder_.path / out / "slurm"), {}));
  }

  TemporaryFolder folder_;
};

TEST_F(SlurmStudy, GivesTheSameBitsAsHere) {
  ASSERT_EQ(run("there"), 0) << messages();
  ASSERT_EQ(run_here("here"), 0) << messages();
  EXPECT_EQ(members_of(folder_.path / "there"), members_of(folder_.path / "here"));
  EXPECT_EQ(read_file(folder_.path / "there/table.csv"), read_file(folder_.path / "here/table.csv"));
}

TEST_F(SlurmStudy, NamesAMemberThatFailsAndGoesOn) {
  write_study_of({"good", "bad"});
  EXPECT_EQ(run("out"), 1) << messages();
  EXPECT_NE(rows("out").find("bad-seed-2,bad,1 ms,2,failed,\"exit 1: trackbed: stage settle: not at rest"),
            std::string::npos)
      << rows("out");
  EXPECT_NE(rows("out").find("good-seed-2,good,,2,done"), std::string::npos) << rows("out");
  EXPECT_EQ(run("out"), 1);  // remembered, not run again
  EXPECT_EQ(jobs("out"), 1);
}

TEST_F(SlurmStudy, NamesAMemberThatSomebodyCancels) {
  write_study_of({"good", "endless"});
  StudyProcess study = start("out");
  ASSERT_TRUE(comes_true([&] { return has_begun("out", "endless-seed-1"); })) << messages();
  shell("scancel " + job_of("out") + "_1");  // runs
  shell("scancel " + job_of("out") + "_3");  // waits, or runs
  EXPECT_EQ(study.wait(), 1);
  EXPECT_NE(rows("out").find(",1,failed,cancelled in Slurm"), std::string::npos) << rows("out");
  EXPECT_NE(rows("out").find(",2,failed,cancelled in Slurm"), std::string::npos) << rows("out");
  EXPECT_NE(rows("out").find("good-seed-2,good,,,2,done"), std::string::npos) << rows("out");
}

TEST_F(SlurmStudy, NamesAMemberThatRunsIntoTheTimeLimit) {
  write_study_of({"good", "endless"});
  // Slurm counts in minutes; --time-min does not help. OverTimeLimit is 0.
  EXPECT_EQ(run("out", {"--repeats", "1", "--sbatch=--time=0:01"}), 1);
  EXPECT_NE(rows("out").find("endless-seed-1"), std::string::npos);
  EXPECT_NE(rows("out").find("1,failed,Slurm's time limit"), std::string::npos) << rows("out");
  EXPECT_NE(rows("out").find("good-seed-1,good,,,1,done"), std::string::npos) << rows("out");
}

TEST_F(SlurmStudy, GoesOnWaitingForItsArrayAfterItWasKilled) {
  write_study_of({"good", "endless"});
  StudyProcess first = start("out", {"--repeats", "1"});
  ASSERT_TRUE(comes_true([&] { return has_begun("out", "endless-seed-1"); })) << messages();
  first.kill();
  const std::string job = job_of("out");
  StudyProcess second = start("out", {"--repeats", "1"});
  ASSERT_TRUE(comes_true([&] { return messages().find("members of an earlier call") != std::string::npos; }))
      << messages();
  EXPECT_EQ(run_here("out"), 2);  // not here while it runs there
  second.kill();
  // What ends while nobody waits is collected as well.
  shell("scancel " + job + "_1");
  ASSERT_TRUE(
      comes_true([&] { return shell("squeue --noheader --me --states=PD,R,CG | grep trackbed") != 0; }));
  EXPECT_EQ(run("out", {"--repeats", "1"}), 1);
  EXPECT_EQ(jobs("out"), 1);
  EXPECT_NE(rows("out").find(",1,failed,cancelled in Slurm"), std::string::npos) << rows("out");
  EXPECT_NE(rows("out").find("good-seed-1,good,,,1,done"), std::string::npos) << rows("out");
}

TEST_F(SlurmStudy, SubmitsOnlyWhatIsMissingAndWhatHasChanged) {
  write_study_of({"good"});
  ASSERT_EQ(run("out"), 0) << messages();
  write_study_of({"good", "bad"});
  EXPECT_EQ(run("out"), 1);
  EXPECT_NE(messages().find("4 members: 2 done, 0 failed, 2 to run"), std::string::npos) << messages();
  EXPECT_EQ(jobs("out"), 2);
}

TEST_F(SlurmStudy, CancelsMembersWhoseInputHasChanged) {
  write_study_of({"endless"});
  StudyProcess first = start("out");
  ASSERT_TRUE(comes_true([&] { return has_begun("out", "endless-seed-1"); })) << messages();
  first.kill();
  write_study("[[conditions]]\nname = \"endless\"\nset = [\"stages.settle.time_limit=1000 s\"]\n");
  EXPECT_EQ(run("out"), 0) << messages() << rows("out");
  EXPECT_NE(rows("out").find("endless-seed-2,endless,1000 s,2,done"), std::string::npos) << rows("out");
}

TEST_F(SlurmStudy, OutlivesANodeThatGoesDownAndComesBack) {
  const std::string node = TRACKBED_ROOT "/scripts/slurm/node.sh ";
  // so slow that the node goes down in the middle
  write_study("set = [\"stages.settle.unbalanced_ratio=1e-9\", \"stages.settle.time_limit=1000 s\"]\n");
  StudyProcess study = start("out");
  ASSERT_TRUE(comes_true([&] { return has_begun("out", "case-seed-1"); })) << messages();
  shell(node + "kill");
  ASSERT_TRUE(comes_true([&] { return shell("sinfo --noheader --format=%T | grep down") == 0; }));
  EXPECT_NE(rows("out").find("case-seed-1,case,1,waiting"), std::string::npos) << rows("out");
  shell(node + "start");
  EXPECT_EQ(study.wait(), 0) << messages() << rows("out");
  ASSERT_EQ(run_here("here"), 0);
  EXPECT_EQ(members_of(folder_.path / "out"), members_of(folder_.path / "here"));
}

TEST_F(SlurmStudy, WaitsForASlurmThatDoesNotAnswer) {
  StudyProcess study = start("out");
  ASSERT_TRUE(comes_true([&] { return messages().find("submitted") != std::string::npos; }));
  shell("kill $(cat $TRACKBED_SLURM/slurmctld.pid)");
  EXPECT_TRUE(
      comes_true([&] { return messages().find("Slurm does not answer, waiting") != std::string::npos; }));
  shell("slurmctld");
  EXPECT_EQ(study.wait(), 0) << messages();
}

TEST_F(SlurmStudy, TellsWhatSlurmRefuses) {
  EXPECT_EQ(run("out", {"--sbatch=--partition=nowhere"}), 2);
  EXPECT_NE(messages().find("invalid partition specified: nowhere"), std::string::npos) << messages();
  EXPECT_EQ(run("out"), 0) << messages();
}

}  // namespace
}  // namespace trackbed
