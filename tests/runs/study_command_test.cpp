// trackbed study as a user calls it: it goes on after any end, and its tables do not tell.
#include <fcntl.h>
#include <gtest/gtest.h>
#include <signal.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <filesystem>
#include <sstream>
#include <thread>

#include "base/rng.h"
#include "io/files.h"
#include "scenes/temporary_folder.h"

extern char** environ;

namespace trackbed {
namespace {

namespace fs = std::filesystem;

constexpr const char* balls_in_a_box = R"toml(
title = "Balls in a box"
stones.fidelity = "ball"
materials.ballast = { kn = "1e6 N/m", ks = "1e6 N/m", friction = 0.5, density = "2650 kg/m^3" }
walls.box = { kind = "box", size = ["0.2 m", "0.2 m", "0.1 m"], material = "ballast" }
record.picture = false
record.tables = false
record.paraview_stones = "none"
[[stages]]
kind = "fill"
[[stages]]
kind = "settle"
)toml";

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

  pid_t start(const std::string& out, const std::vector<std::string>& further = {}) const {
    std::vector<std::string> words{TRACKBED_PROGRAM,
                                   "study",
                                   (folder_.path / "study.toml").string(),
                                   "--out",
                                   (folder_.path / out).string(),
                                   "--jobs",
                                   "2"};
    words.insert(words.end(), further.begin(), further.end());
    std::vector<char*> argv;
    for (std::string& word : words) argv.push_back(word.data());
    argv.push_back(nullptr);
    posix_spawn_file_actions_t actions;
    ::posix_spawn_file_actions_init(&actions);
    for (int stream : {STDOUT_FILENO, STDERR_FILENO})
      ::posix_spawn_file_actions_addopen(&actions, stream, (folder_.path / "messages.txt").c_str(),
                                         O_WRONLY | O_CREAT | O_APPEND, 0644);
    pid_t process = 0;
    EXPECT_EQ(::posix_spawn(&process, TRACKBED_PROGRAM, &actions, nullptr, argv.data(), environ), 0);
    ::posix_spawn_file_actions_destroy(&actions);
    return process;
  }
  static int wait(pid_t process) {
    int status = 0;
    ::waitpid(process, &status, 0);
    return WIFEXITED(status) ? WEXITSTATUS(status) : -WTERMSIG(status);
  }
  int run(const std::string& out, const std::vector<std::string>& further = {}) const {
    return wait(start(out, further));
  }
  std::string messages() const { return read_file(folder_.path / "messages.txt"); }

  /// study.csv without the wall times.
  std::string members(const std::string& out) const {
    std::istringstream in(read_file(folder_.path / out / "study.csv"));
    std::string all, line;
    while (std::getline(in, line)) {
      const std::size_t last = line.rfind(','), before = line.rfind(',', last - 1);
      all += line.substr(0, before) + line.substr(last) + "\n";
    }
    return all;
  }

  TemporaryFolder folder_;
};

TEST_F(StudyCommand, IsTheSameHoweverOftenItIsKilled) {
  ASSERT_EQ(run("calm"), 0) << messages();
  Rng rng(1, "when to kill");
  int kills = 0;
  for (int tries = 0; tries < 100; ++tries) {
    const pid_t process = start("killed");
    std::this_thread::sleep_for(std::chrono::milliseconds(50 + static_cast<int>(rng.index(400))));
    if (kills < 6 && ::kill(process, SIGKILL) == 0) ++kills;
    if (wait(process) == 0) break;
  }
  EXPECT_GE(kills, 3);
  EXPECT_EQ(members("killed"), members("calm"));
  EXPECT_EQ(read_file(folder_.path / "killed/table.csv"), read_file(folder_.path / "calm/table.csv"));
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
  EXPECT_EQ(run("wide", {"--repeat-until", "contacts < 100 %"}), 0) << messages();
  EXPECT_FALSE(fs::exists(folder_.path / "wide/members/friction_0.5-seed-4"));
  EXPECT_EQ(run("wrong", {"--repeat-until", "contacts"}), 2);
}

}  // namespace
}  // namespace trackbed
