// A run begins where another one stood that was the same so far, and finds the same bits.
#include <gtest/gtest.h>

#include "io/files.h"
#include "lab/run.h"
#include "scenes/temporary_folder.h"

namespace trackbed {
namespace {

namespace fs = std::filesystem;

constexpr const char* pushed = R"toml(
title = "Pushed"
[stones]
shapes = 2
distance = "120 deg"
ratio = 0.5
[materials.ballast]
kn = "1e6 N/m"
ks = "1e6 N/m"
friction = 0.5
density = "2630 kg/m^3"
[walls.box]
kind = "box"
size = ["200 mm", "200 mm", "120 mm"]
material = "ballast"
[record]
picture = false
keep = ["pour", "rest"]
[[stages]]
kind = "fill"
density = 0.3
[[stages]]
kind = "settle"
name = "pour"
unbalanced_ratio = 0.3
[[stages]]
kind = "settle"
name = "rest"
unbalanced_ratio = 0.1
[[stages]]
kind = "move"
name = "push"
wall = "box.right"
velocity = ["-0.2 m/s", "0 m/s", "0 m/s"]
duration = "8 ms"
)toml";

class StageEnds : public testing::Test {
 protected:
  Summary run(const std::vector<std::string>& changes, bool keeps = true) {
    const Document document = Document::from_text(pushed, "case.toml", changes);
    CaseInput input;
    document.read(input);
    RunOptions options{.out = folder_.path / std::to_string(++runs_), .threads = 1, .quiet = true};
    if (keeps) options.keep = folder_.path / "kept";
    return trackbed::run(document, input, options);
  }
  static int taken_over(const Summary& summary) {
    return static_cast<int>(std::ranges::count(summary.stages, true, &StageSummary::taken_over));
  }
  std::size_t kept() const { return expand_pattern(folder_.path / "kept/*.end").size(); }

  TemporaryFolder folder_;
  int runs_ = 0;
};

TEST_F(StageEnds, ARunThatIsTheSameSoFarBeginsThereWithTheSameBits) {
  const Summary first = run({});
  EXPECT_EQ(taken_over(first), 0);
  EXPECT_EQ(kept(), 2u);
  const std::vector<std::string> slower{"stages.push.velocity=[\"-0.1 m/s\", \"0 m/s\", \"0 m/s\"]",
                                        "title=Pushed slowly", "record.every=0.5 ms"};
  const Summary alone = run(slower, false), after = run(slower);
  EXPECT_EQ(taken_over(alone), 0);
  EXPECT_EQ(taken_over(after), 3);
  EXPECT_EQ(after.state_hash, alone.state_hash);
  EXPECT_NE(after.state_hash, first.state_hash);
  ASSERT_EQ(after.stages.size(), alone.stages.size());
  for (std::size_t k = 0; k < alone.stages.size(); ++k) {
    EXPECT_EQ(after.stages[k].steps, alone.stages[k].steps) << k;
    EXPECT_EQ(after.stages[k].results.size(), alone.stages[k].results.size()) << k;
  }
  EXPECT_TRUE(to_json(after)["stages"][2].contains("taken_over"));
  EXPECT_FALSE(to_json(after)["stages"][3].contains("taken_over"));
}

TEST_F(StageEnds, WhatDiffersBeforeIsNotTakenOver) {
  run({});
  EXPECT_EQ(taken_over(run({"seed=2"})), 0);
  EXPECT_EQ(taken_over(run({"materials.ballast.friction=0.4"})), 0);
  EXPECT_EQ(taken_over(run({"stages.rest.unbalanced_ratio=0.2"})), 2);  // only what comes before `rest`
  EXPECT_EQ(taken_over(run({"record.keep=[]"})), 0);
}

TEST_F(StageEnds, WhereARegionComesFromAFileNothingIsKept) {
  const fs::path field = folder_.path / "field.csv";
  write_file(field, "x [m],y [m],z [m],displacement [m]\n0,0,0,1\n");
  run({"regions.stirred={kind = \"field\", file = \"" + field.string() + "\", above = 0.5}"});
  EXPECT_EQ(kept(), 0u);
}

TEST_F(StageEnds, ABrokenFileIsPassedOver) {
  run({});
  for (const fs::path& file : expand_pattern(folder_.path / "kept/*.end"))
    write_file(file, read_file(file).substr(0, 1000));
  EXPECT_EQ(taken_over(run({})), 0);
}

}  // namespace
}  // namespace trackbed
