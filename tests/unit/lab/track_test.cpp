// A short track case on springs, from file to results.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <string>
#include <vector>

#include "io/csv.h"
#include "io/files.h"
#include "lab/track/track_record.h"
#include "lab/track/track_run.h"
#include "scenes/temporary_folder.h"

namespace trackbed {
namespace {

constexpr const char* short_track = R"(title = "short"
[track]
lead_in = "4.8 m"
approach = "6 m"
bridge = "3 m"
departure = "6 m"
run_out = "0 m"
settlement = "2 mm"
[track.ground]
model = "springs"
[track.sleeper]
patches = 2
[train]
speed_up = "20 ms"
[train.vehicle]
bogie_distance = "5 m"
wheelbase = "1.8 m"
[record]
paraview_every = "50 ms"
sleepers = [-1, 1]
)";

Summary run_short(const std::filesystem::path& out, const std::vector<std::string>& set = {}) {
  const Document document = Document::from_text(short_track, "short.toml", set);
  TrackCaseInput in;
  document.read(in);
  return run_track(document, in, {.out = out, .threads = 1, .quiet = true});
}

double measure(const Summary& summary, const std::string& name) {
  const auto found = std::ranges::find(summary.measures, name, &Result::name);
  return found == summary.measures.end() ? std::nan("") : found->value;
}

TEST(TrackCase, LeavesTablesAndFrames) {
  const TemporaryFolder folder;
  const Summary summary = run_short(folder.path);
  for (const char* file : {"summary.json", "series.csv", "sleepers.csv", "paraview/track.pvd",
                           "paraview/frames/track-00000.vtp"})
    EXPECT_GT(std::filesystem::file_size(folder.path / file), 100u) << file;
  const std::string table = read_file(folder.path / "sleepers.csv");
  EXPECT_EQ(std::ranges::count(table, '\n'), 8 + 10 + 5 + 10 + 1);
  EXPECT_GT(measure(summary, "departure.hanging_sleepers"), 0);
  EXPECT_GT(measure(summary, "departure.peak_force"), 20e3);
  // Four wheels of 19 t a pair carry the vehicle, more or less, at every moment.
  EXPECT_GT(measure(summary, "wheel_force_max"), 93e3);
  EXPECT_LT(std::abs(summary.stages[1].energy_error), 0.05 * measure(summary, "energy_put_in"));
}

TEST(TrackCase, GivesTheSameBitsAgain) {
  const TemporaryFolder folder;
  EXPECT_EQ(run_short(folder.path).state_hash, run_short(folder.path).state_hash);
}

TEST(TrackCase, StiffMeasuredSupportIsLikeStiffSprings) {
  const TemporaryFolder folder;
  const Summary measured =
      run_short(folder.path,
                {R"(track.support={sinking=["0 mm","1 mm"], force=["0 kN","100 kN"], unloading="1e8 N/m"})"});
  // Ground of the same stiffness in series with the penalty of the contact, hardly any mass or damping.
  const Summary springs =
      run_short(folder.path, {"track.springs.stiffness=5e7 N/m", "track.springs.mass=0.1 kg",
                              "track.springs.damping=1 N s/m", "track.sleeper.contact=1e12 N/m"});
  const double a = measure(measured, "departure.peak_force"), b = measure(springs, "departure.peak_force");
  EXPECT_NEAR(a, b, 0.03 * b);
}

TEST(TrackCase, SleepersOnSupportsOfTheirOwnAreAsOnMeasuredSupport) {
  const TemporaryFolder folder;
  write_file(folder.path / "curve.csv", "sinking [mm],force [kN]\n0,0\n1,100\n");
  const std::string curve = (folder.path / "curve.csv").string();
  const auto forces = [&](const std::vector<std::string>& set) {
    run_short(folder.path, set);
    return CsvTable(folder.path / "sleepers.csv").numbers("peak_force", Dimension::force);
  };
  const std::vector<double> all =
      forces({R"(track.support={sinking=["0 mm","1 mm"], force=["0 kN","100 kN"], unloading="1e8 N/m"})"});
  const std::vector<double> own = forces({fmt::format(
      R"(track.supports=[{{from=-10, to=-3, curve="{0}"}}, {{from=-2, to=10, curve="{0}"}}])", curve)});
  const std::vector<double> settled =
      forces({fmt::format(R"(track.supports=[{{from=-10, to=10, curve="{0}", settlement="1 mm"}}])", curve),
              "track.settlement=1 mm"});
  const std::vector<double> some =
      forces({fmt::format(R"(track.supports=[{{from=1, to=3, curve="{0}"}}])", curve)});
  const std::vector<double> none = forces({});
  ASSERT_EQ(own.size(), all.size());
  for (std::size_t k = 0; k < all.size(); ++k) {
    EXPECT_NEAR(own[k], all[k], 1e-6 * 1e5) << k;
    // The lead-in lies 1 mm higher, which is felt a little behind the bridge.
    if (k >= 23) {
      EXPECT_NEAR(settled[k], all[k], 0.005 * 1e5) << k;
    }
  }
  // Three sleepers behind the bridge on softer supports leave what lies far from them as it was.
  EXPECT_NEAR(some[9], none[9], 1e-3 * none[9]);
  EXPECT_GT(std::abs(some[24] - none[24]), 1e-2 * none[24]);
}

TEST(TrackCase, SleepersAreCountedFromTheBridge) {
  TrackLayoutInput track;
  track.lead_in = 1.2, track.approach = 1.8, track.bridge = 1.2, track.departure = 1.2, track.run_out = 0;
  std::vector<int> numbers;
  for (int k = 0; k < 9; ++k) numbers.push_back(sleeper_number(track, k));
  EXPECT_EQ(numbers, (std::vector<int>{-5, -4, -3, -2, -1, 0, 0, 1, 2}));
}

}  // namespace
}  // namespace trackbed
