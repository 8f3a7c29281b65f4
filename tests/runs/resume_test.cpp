// A run that is stopped again and again, in every kind of stage, ends with the same bits as one that never
// was.
#include <gtest/gtest.h>

#include <map>
#include <set>

#include "base/error.h"
#include "base/rng.h"
#include "expected.h"
#include "io/files.h"
#include "lab/checkpoint.h"
#include "lab/run.h"
#include "scenes/temporary_folder.h"

namespace trackbed {
namespace {

namespace fs = std::filesystem;

constexpr const char* poured = R"toml(
title = "Poured, loaded and pushed"
seed = 5
[stones]
shapes = 2
distance = "120 deg"
ratio = 0.5
[contact]
law = "linear_rolling"
dashpot = { normal = 0.1, shear = 0.1 }
[materials.ballast]
kn = "1e6 N/m"
ks = "1e6 N/m"
friction = 0.5
rolling_friction = 0.1
density = "2630 kg/m^3"
[walls.box]
kind = "box"
size = ["200 mm", "200 mm", "120 mm"]
material = "ballast"
[bodies.plate]
kind = "block"
size = ["60 mm", "60 mm", "60 mm"]
material = "ballast"
[record]
every = "0.7 ms"
paraview_every = "11 ms"
picture = false
measures = ["porosity"]
[[stages]]
kind = "fill"
density = 0.3
[[stages]]
kind = "settle"
unbalanced_ratio = 0.3
friction = 0.1
gravity = "50 m/s^2"
[[stages]]
kind = "settle"
name = "rest"
unbalanced_ratio = 0.2
scaled_step = true
[[stages]]
kind = "insert"
body = "plate"
embedment = "10 mm"
held = true
[[stages]]
kind = "hold"
duration = "8 ms"
[[stages]]
kind = "release"
body = "plate"
[[stages]]
kind = "load"
body = "plate"
waveform = "sine"
force_max = "100 N"
frequency = "50 Hz"
duration = "25 ms"
ramp = "5 ms"
[[stages]]
kind = "move"
wall = "box.right"
velocity = ["0.2 m/s", "0 m/s", "0 m/s"]
duration = "8 ms"
probes = ["0.5 mm", "1 mm"]
mean_over = "0.4 mm"
levels = ["5 N", "20 N", "1 MN"]
measures = ["contacts", "box.right.contact_force_max"]
[[stages]]
kind = "servo"
wall = "box.front"
force = "200 N"
direction = [0, 1, 0]
duration = "8 ms"
[[stages]]
kind = "repeat"
times = 3
measures = ["coordination_number"]
  [[stages.stages]]
  kind = "hold"
  duration = "3 ms"
  [[stages.stages]]
  kind = "move"
  wall = "box.right"
  velocity = ["-0.2 m/s", "0 m/s", "0 m/s"]
  duration = "3 ms"
)toml";

constexpr const char* replaced = R"toml(
title = "Bed by replacement"
seed = 3
[stones]
shapes = 2
distance = "120 deg"
ratio = 0.5
[stones.sets.ball]
fidelity = "ball"
[materials.ballast]
kn = "1e6 N/m"
ks = "1e6 N/m"
friction = 0.5
density = "2630 kg/m^3"
[walls.box]
kind = "box"
size = ["200 mm", "200 mm", "120 mm"]
material = "ballast"
[walls.lid]
kind = "plane"
point = ["0 mm", "0 mm", "120 mm"]
normal = [0, 0, -1]
material = "ballast"
[record]
every = "0.7 ms"
stages = ["hold"]
[[stages]]
kind = "scatter"
set = "ball"
porosity = 0.55
[[stages]]
kind = "replace"
[[stages]]
kind = "adjust"
friction = 0.2
unbalanced_ratio = 0.1
[[stages]]
kind = "remove"
walls = ["lid"]
[[stages]]
kind = "hold"
duration = "5 ms"
)toml";

/// Runs a case; `stop` is asked after each step.
Summary run_case(const char* text, const fs::path& out, int threads, const std::function<bool()>& stop = {},
                 bool resume = false) {
  const Document document = Document::from_text(text, "case.toml", {});
  CaseInput experiment;
  document.read(experiment);
  RunOptions options;
  options.out = out;
  options.threads = threads;
  options.quiet = true;
  options.resume = resume;
  options.stop = stop;
  Summary summary = run(document, experiment, options);
  expect_foreseen(experiment, summary);
  return summary;
}

/// Every file below a folder but the summary, which tells times of the clock.
std::map<std::string, std::string> files_below(const fs::path& folder) {
  std::map<std::string, std::string> files;
  for (const auto& entry : fs::recursive_directory_iterator(folder))
    if (entry.is_regular_file() && entry.path().filename() != "summary.json")
      files[entry.path().lexically_relative(folder).string()] = read_file(entry.path());
  return files;
}

/// All that the summary tells, without seconds of the clock and the number of threads.
nlohmann::ordered_json told(const Summary& summary) {
  Summary timeless = summary;
  timeless.wall = 0;
  timeless.threads = 0;
  for (StageSummary& stage : timeless.stages) stage.wall = 0;
  return to_json(timeless);
}

class Resume : public testing::TestWithParam<const char*> {
 protected:
  TemporaryFolder folder_;
  fs::path whole_ = folder_.path / "whole", broken_ = folder_.path / "broken";
};

TEST_P(Resume, StoppedInEveryStageItEndsWithTheSameBits) {
  const Summary whole = run_case(GetParam(), whole_, 1);
  // Twice in each stage, anywhere.
  Rng rng(11, "stops");
  std::set<int> stops;
  int first = 0;
  for (const StageSummary& stage : whole.stages) {
    const int steps = static_cast<int>(stage.steps);
    for (int k = 0; k < 2 && steps > 0; ++k)
      stops.insert(first + 1 + static_cast<int>(rng.index(static_cast<std::uint32_t>(steps))));
    first += steps;
  }
  ASSERT_GT(stops.size(), 5u);
  int step = 0;
  std::size_t runs = 1;
  for (;; ++runs) {
    try {
      const Summary parts = run_case(
          GetParam(), broken_, 1 + static_cast<int>(runs % 2), [&] { return stops.contains(++step); },
          runs > 1);
      EXPECT_EQ(told(parts), told(whole));
      break;
    } catch (const Stopped&) {
    }
  }
  EXPECT_EQ(runs, stops.size() + 1);
  EXPECT_FALSE(fs::exists(broken_ / "checkpoint"));  // no longer needed
  const auto a = files_below(whole_), b = files_below(broken_);
  ASSERT_EQ(a.size(), b.size());
  for (const auto& [name, bytes] : a) EXPECT_TRUE(b.contains(name) && b.at(name) == bytes) << name;
}

INSTANTIATE_TEST_SUITE_P(Cases, Resume, testing::Values(poured, replaced),
                         [](const auto& one) { return one.index == 0 ? "Poured" : "Replaced"; });

class Checkpoint : public testing::Test {
 protected:
  /// Leaves a run that was stopped after some steps.
  void stop_after(int steps) {
    EXPECT_THROW(run_case(replaced, folder_.path, 1, [&] { return --steps == 0; }), Stopped);
  }
  std::vector<fs::path> files() const { return expand_pattern(folder_.path / "checkpoint" / "*"); }
  TemporaryFolder folder_;
};

TEST_F(Checkpoint, ABrokenOneIsPassedOverForTheOneBefore) {
  stop_after(600);  // beyond the first stage's end, where one was left
  ASSERT_EQ(files().size(), 2u);
  const std::string bytes = read_file(files()[1]);
  write_file(files()[1], bytes.substr(0, bytes.size() / 2));
  std::string end;
  try {
    run_case(
        replaced, folder_.path, 1, [] { return true; }, true);
  } catch (const Stopped& stopped) {
    end = stopped.what();
  }
  EXPECT_TRUE(end.starts_with("stopped in stage replace at step ")) << end;
  EXPECT_EQ(files().size(), 2u);
}

TEST_F(Checkpoint, OfAnotherCaseIsRefusedWithTheKeyThatDiffers) {
  stop_after(100);
  std::string other = replaced;
  other.replace(other.find("friction = 0.5"), 14, "friction = 0.6");
  try {
    run_case(other.c_str(), folder_.path, 1, {}, true);
    FAIL() << "the case was changed";
  } catch (const InputError& error) {
    EXPECT_NE(std::string(error.what()).find("materials.ballast.friction: 0.5 -> 0.6"), std::string::npos)
        << error.what();
  }
}

TEST_F(Checkpoint, OfAnotherVersionIsRefusedAndTheResultsStay) {
  stop_after(100);
  ASSERT_EQ(files().size(), 1u);
  std::string bytes = read_file(files()[0]);
  bytes.replace(0, state_format.size(), "trackbed state 1\n");
  write_file(files()[0], bytes);
  const std::string series = read_file(folder_.path / "series.csv");
  try {
    run_case(replaced, folder_.path, 1, {}, true);
    FAIL() << "the checkpoint means something else";
  } catch (const InputError& error) {
    EXPECT_EQ(error.what(), (folder_.path / "checkpoint").string() +
                                ": no checkpoint here is whole and of this version of the program; leave out "
                                "--resume to begin anew");
  }
  EXPECT_EQ(read_file(folder_.path / "series.csv"), series);
  EXPECT_EQ(read_file(files()[0]), bytes);
}

TEST_F(Checkpoint, ABitThatFellOverIsNoticed) {
  write_checked(folder_.path / "state", "some bytes, not a multiple of eight");
  EXPECT_EQ(read_checked(folder_.path / "state"), "some bytes, not a multiple of eight");
  std::string bytes = read_file(folder_.path / "state");
  for (const std::size_t at : {bytes.size() - 1, bytes.size() / 2, std::size_t{3}}) {
    std::string wrong = bytes;
    wrong[at] = static_cast<char>(wrong[at] ^ 4);
    write_file(folder_.path / "state", wrong);
    EXPECT_EQ(read_checked(folder_.path / "state"), std::nullopt) << at;
  }
}

}  // namespace
}  // namespace trackbed
