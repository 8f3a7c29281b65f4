// trackbed apss, as a user calls it: balls first, then clumps where the balls were stirred most.
#include <gtest/gtest.h>

#include <cstdlib>
#include <nlohmann/json.hpp>

#include "io/files.h"
#include "scenes/temporary_folder.h"

namespace trackbed {
namespace {

namespace fs = std::filesystem;

constexpr const char* pressed_bed = R"toml(
title = "A plate pressed into a bed"
seed = 4
[stones]
shapes = 2
distance = "110 deg"
ratio = 0.5
[stones.grading]
sieves = ["20 mm", "30 mm"]
passing = ["0 %", "100 %"]
[stones.sets.stand_in]
fidelity = "stand_in"
[stones.sets.ball]
fidelity = "ball"
[materials.ballast]
kn = "1e6 N/m"
ks = "1e6 N/m"
friction = 0.5
density = "2630 kg/m^3"
[walls.box]
kind = "box"
size = ["200 mm", "200 mm", "300 mm"]
material = "ballast"
[walls.lid]
kind = "plane"
point = ["0 mm", "0 mm", "120 mm"]
normal = [0, 0, -1]
material = "ballast"
[bodies.plate]
kind = "block"
size = ["80 mm", "80 mm", "20 mm"]
material = "ballast"
mass = "1 kg"
free = []
[regions.shaped]
kind = "box"
above = "0 mm"
[record]
picture = false
paraview_stones = "none"
[[stages]]
kind = "scatter"
name = "clumps"
set = "stand_in"
region = "shaped"
porosity = 0.5
[[stages]]
kind = "scatter"
name = "balls"
set = "ball"
region = "shaped"
outside = true
porosity = 0.5
[[stages]]
kind = "replace"
region = "shaped"
[[stages]]
kind = "remove"
walls = ["lid"]
[[stages]]
kind = "settle"
unbalanced_ratio = 0.05
[[stages]]
kind = "insert"
body = "plate"
[[stages]]
kind = "move"
name = "press"
wall = "plate"
velocity = ["0 m/s", "0 m/s", "-50 mm/s"]
distance = "10 mm"
)toml";

class Apss : public testing::Test {
 protected:
  Apss() { write_file(folder_.path / "case.toml", pressed_bed); }

  /// Exit code of the command, with results in `out`; what it says is in out.txt beside.
  int apss(const std::string& out, const std::string& options = {}, const std::string& before = {}) const {
    const std::string at = "'" + (folder_.path / out).string();
    const std::string command = before + " " + TRACKBED_PROGRAM + " apss '" +
                                (folder_.path / "case.toml").string() + "' --share 0.3 --threads 1 --out " +
                                at + "' " + options + " > " + at + ".txt' 2>&1";
    const int status = std::system(command.c_str());
    return WIFEXITED(status) ? WEXITSTATUS(status) : -WTERMSIG(status);
  }
  nlohmann::json results(const std::string& out) const {
    return nlohmann::json::parse(read_file(folder_.path / out / "adapted" / "summary.json"));
  }
  std::string told(const std::string& out) const { return read_file(folder_.path / (out + ".txt")); }

  TemporaryFolder folder_;
};

TEST_F(Apss, ThatShareOfTheStonesHasShapes) {
  ASSERT_EQ(apss("out"), 0) << told("out");
  const auto measures = results("out")["measures"];
  const double stones = measures["stones"]["value"], shaped = measures["replace.replaced"]["value"];
  // The area is known by where balls lay, in a bed that was placed anew: some stones lie on its edge.
  EXPECT_NEAR(shaped / stones, 0.3, 0.1);
  EXPECT_GT(double(measures["pebbles"]["value"]), stones + shaped);
  EXPECT_NE(told("out").find("fewer pebbles than with shapes everywhere"), std::string::npos) << told("out");
}

TEST_F(Apss, StoppedAndTakenUpAgainItEndsWithTheSameBits) {
  ASSERT_EQ(apss("whole"), 0) << told("whole");
  // Wherever the signal falls; a machine that is done before loses nothing either.
  apss("stopped", "", "timeout --signal=TERM 1");
  ASSERT_EQ(apss("stopped", "--resume"), 0) << told("stopped");
  EXPECT_EQ(results("stopped")["state_hash"], results("whole")["state_hash"]);
  // What is there already is not run again; balls of another seed are.
  ASSERT_EQ(apss("stopped", "--resume"), 0);
  EXPECT_NE(told("stopped").find("adapted holds the results of this case already"), std::string::npos)
      << told("stopped");
  ASSERT_EQ(apss("stopped", "--set seed=5"), 0);
  EXPECT_EQ(told("stopped").find("holds the results"), std::string::npos) << told("stopped");
  EXPECT_NE(results("stopped")["state_hash"], results("whole")["state_hash"]);
}

// The stage that decides is recorded whatever the case records.
TEST_F(Apss, ACaseThatRecordsOtherStagesIsAdaptedAllTheSame) {
  EXPECT_EQ(apss("out", "--prepare-only --set 'record.stages=[\"settle\"]' --set 'record.keep=[\"press\"]'"),
            0)
      << told("out");
}

TEST_F(Apss, AWrongTimeOrStageIsRefused) {
  EXPECT_EQ(apss("out", "--checkpoint-every '5 mm'"), 2);
  EXPECT_NE(told("out").find("--checkpoint-every 5 mm"), std::string::npos) << told("out");
  EXPECT_EQ(apss("out", "--stage pres"), 2);
  EXPECT_NE(told("out").find("--stage pres: the case has no stage of that name"), std::string::npos);
}

}  // namespace
}  // namespace trackbed
