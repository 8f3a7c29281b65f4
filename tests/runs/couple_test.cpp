// Track and bed coupled: by formula, by hand, and a tiny bed under a short track.
#include <gtest/gtest.h>

#include <cmath>

#include "base/error.h"
#include "io/files.h"
#include "lab/coupling.h"
#include "lab/track/sleeper_peaks.h"
#include "lab/track/track_run.h"
#include "scenes/temporary_folder.h"

namespace trackbed {
namespace {

namespace fs = std::filesystem;

/// Pressed along a line of `stiffness` after it has settled.
PressHistory line(double stiffness, double force, double settled) {
  PressHistory h;
  for (const double share : {0.0, 1.0, 0.0})
    h.sinking.push_back(share * force / stiffness), h.force.push_back(share * force);
  for (const double share : {0.0, 0.5, 1.0})
    h.sinking.push_back(settled + share * force / stiffness), h.force.push_back(share * force);
  return h;
}

// A bed that settles by b F and a track in which the force grows by a with each metre of that: F = F0 + a b
// F.
TEST(Couple, FindsTheFixedPointOfLinearLaws) {
  const double f0 = 80e3, a = 2e7, b = 1e-8;
  const auto rounds = couple(
      1e-9, 50, 1,
      [&](const std::vector<PressHistory>& beds, int) {
        std::vector<std::vector<double>> peaks(1, {f0, 0.5 * f0});
        if (!beds.empty()) peaks[0][0] += a * support_curve(beds[0]).settlement;
        return peaks;
      },
      [&](std::size_t, double force, int) { return line(2e8, force, b * force); });
  EXPECT_NEAR(rounds.back().peak, f0 / (1 - a * b), 1e-6 * f0);
  EXPECT_NEAR(rounds.back().load, rounds.back().peak, 1e-8 * f0);
  EXPECT_LE(rounds.back().change, 1e-9);
  for (std::size_t k = 1; k < rounds.size(); ++k)  // each round is a b nearer
    EXPECT_NEAR(rounds[k].change * rounds[k].peak, a * b * rounds[k - 1].change * rounds[k - 1].peak, 1);
}

// The passage answers a load by a smaller one and the other way round: rounds alone would swing for ever.
TEST(Couple, TakesTheChordWhereRoundsSwing) {
  const auto rounds = couple(
      1e-6, 6, 1,
      [&](const std::vector<PressHistory>& beds, int) {
        const double load = beds.empty() ? 60e3 : support_curve(beds[0]).force.back();
        return std::vector<std::vector<double>>{{160e3 - load}};
      },
      [&](std::size_t, double force, int) { return line(2e8, force, 0); });
  EXPECT_NEAR(rounds.back().peak, 80e3, 1);
}

TEST(Couple, SleepersThatComeToHangAreTold) {
  try {
    couple(
        0.01, 5, 1,
        [&](const std::vector<PressHistory>& beds, int) {
          return std::vector<std::vector<double>>{{beds.empty() ? 80e3 : 0.0}};
        },
        [&](std::size_t, double force, int) { return line(2e8, force, 7e-3); });
    FAIL() << "nothing presses";
  } catch (const RunError& error) {
    EXPECT_EQ(std::string(error.what()),
              "round 1: sleepers hang above a bed that has settled by 7 mm under 80 kN; the rails bear the "
              "train, and there is nothing to couple");
  }
}

// Two passages over hanging sleepers are alike, but agree with no load.
TEST(Couple, SleepersThatHangTwiceDoNotAgree) {
  const std::vector<double> peaks{100e3, 150e3, 0, 0, 0, 0};  // by rounds
  const auto passage = [&](const std::vector<PressHistory>&, int round) {
    return std::vector<std::vector<double>>{{peaks[static_cast<std::size_t>(round)]}};
  };
  const auto press = [](std::size_t, double force, int) { return line(2e8, force, 1e-3); };
  EXPECT_THROW(couple(0.01, 5, 1, passage, press), RunError);
}

TEST(Couple, WhatDoesNotSettleDownFails) {
  const auto passage = [](const std::vector<PressHistory>&, int round) {
    return std::vector<std::vector<double>>{{round % 2 == 0 ? 80e3 : 90e3}};
  };
  const auto press = [](std::size_t, double force, int) { return line(2e8, force, 0); };
  EXPECT_THROW(couple(0.01, 5, 1, passage, press), RunError);
  EXPECT_EQ(couple(0.2, 5, 1, passage, press).size(), 1u);
}

/// A track without bridge on the side of interest, rails of Euler beams, a slow train.
constexpr const char* slow_track = R"(title = "slow"
[track]
lead_in = "12 m"
approach = "12 m"
bridge = "0 m"
departure = "0 m"
run_out = "6 m"
[track.rail]
model = "euler"
[track.ground]
model = "springs"
[track.sleeper]
patches = 2
[train]
speed = "5 m/s"
start = "6.8 m"
end = "8.6 m"
speed_up = "50 ms"
[train.vehicle]
bogie_distance = "6 m"
wheelbase = "2 m"
[numerics]
time_step = "1 ms"
)";

// The bed is a line of 2e7 N/m for a sleeper. By hand: an infinite beam on Winkler's foundation, a wheel
// above a sleeper, the other wheels of the rail added (docs/theory.md); and the weight of sleeper and rails.
TEST(Couple, ALinearBedGivesTheForcesOfABeamOnWinklersFoundation) {
  const double bed = 2e7, spacing = 0.6, bending = 2.1e11 * 2338e-8, wheel = 19e3 * 9.81 / 2;
  const TemporaryFolder folder;
  const Document document = Document::from_text(slow_track, "slow.toml");
  TrackCaseInput in;
  document.read(in);
  const SleeperRange all{-20, -1};
  const auto rounds = couple(
      0.01, 5, 1,
      [&](const std::vector<PressHistory>& beds, int round) {
        TrackCaseInput now = in;
        if (!beds.empty()) {
          write_history(beds[0], folder.path / "curve.csv");
          now.track.supports.push_back({all, folder.path / "curve.csv", 0});
        }
        const fs::path out = folder.path / std::to_string(round);
        run_track(document, now, {.out = out, .threads = 1, .quiet = true});
        return std::vector<std::vector<double>>{{read_peaks(out, {-7}).at(0).force}};
      },
      [&](std::size_t, double force, int) { return line(bed, force, 0); });
  EXPECT_EQ(rounds.size(), 2u);                                   // a line is the same under any force
  const double foundation = 1 / (2 / bed + 1 / 1.2e8) / spacing;  // of a rail [N/m^2]
  const double lambda = std::pow(foundation / (4 * bending), 0.25);
  const auto deflection = [&](double x) {  // under a wheel at x = 0
    const double s = lambda * std::abs(x);
    return wheel * lambda / (2 * foundation) * std::exp(-s) * (std::cos(s) + std::sin(s));
  };
  const double under_wheels = deflection(0) + deflection(2) + deflection(6) + deflection(8);
  const double weight = 9.81 * (2.4 * 0.24 * 0.2 * 2400 + 2 * spacing * 69.77e-4 * 7850);
  EXPECT_NEAR(rounds.back().peak, 2 * foundation * spacing * under_wheels + weight,
              0.03 * rounds.back().peak);
}

constexpr const char* tiny_bed = R"(title = "tiny"
[stones]
shapes = 1
fidelity = "ball"
[materials.ballast]
kn = "4e6 N/m"
ks = "4e6 N/m"
friction = 0.5
rolling_friction = 0.3
density = "2630 kg/m^3"
[contact]
law = "linear_rolling"
[walls.box]
kind = "box"
size = ["200 mm", "200 mm", "120 mm"]
material = "ballast"
[bodies.sleeper]
kind = "block"
size = ["120 mm", "120 mm", "40 mm"]
material = "ballast"
free = []
[record]
picture = false
tables = false
paraview_stones = "none"
[[stages]]
kind = "fill"
porosity = 0.45
[[stages]]
kind = "settle"
unbalanced_ratio = 0.05
[[stages]]
kind = "insert"
body = "sleeper"
embedment = "5 mm"
[[stages]]
kind = "move"
name = "seat"
wall = "sleeper"
velocity = ["0 m/s", "0 m/s", "-100 mm/s"]
force = "20 N"
[[stages]]
kind = "move"
name = "press"
wall = "sleeper"
velocity = ["0 m/s", "0 m/s", "-100 mm/s"]
force = "1 kN"
[[stages]]
kind = "move"
name = "lift"
wall = "sleeper"
velocity = ["0 m/s", "0 m/s", "100 mm/s"]
distance = "2 mm"
)";

constexpr const char* short_track = R"(title = "short"
[track]
lead_in = "4.8 m"
approach = "6 m"
bridge = "3 m"
departure = "6 m"
run_out = "0 m"
settlement = "1 mm"
[track.ground]
model = "springs"
[track.sleeper]
patches = 2
[train]
speed_up = "20 ms"
[train.vehicle]
bogie_distance = "5 m"
wheelbase = "1.8 m"
)";

constexpr const char* tiny_coupling = R"(title = "tiny"
tolerance = 0.01
[passage]
case = "track.toml"
[bed]
case = "bed.toml"
set = ["seed=1"]
force = ["stages.press.force"]
stages = ["press", "lift"]
share = 0.001
reach = 1.2
below = "2e8 N/m"
[[sleepers]]
from = 1
to = 2
[[sleepers]]
from = 3
to = 5
)";

std::vector<CouplingRound> run_tiny(const fs::path& folder, const std::vector<std::string>& set = {}) {
  write_file(folder / "track.toml", short_track);
  write_file(folder / "bed.toml", tiny_bed);
  write_file(folder / "coupling.toml", tiny_coupling);
  const Document document(folder / "coupling.toml", set);
  CouplingInput in;
  document.read(in);
  return run_coupling(document, in, {.out = folder / "out", .threads = 1, .quiet = true});
}

TEST(Couple, ATinyBedAndAShortTrackAgree) {
  const TemporaryFolder folder, again;
  const auto rounds = run_tiny(folder.path);
  const fs::path out = folder.path / "out";
  const CouplingRound& last = rounds.back();
  EXPECT_GT(rounds.size(), 2u);
  EXPECT_LE(last.change, 0.01);
  // The sleepers' forces are those of the last passage, and nearly those that the beds were pressed with.
  const std::string passage = "passage-" + std::to_string(last.round);
  EXPECT_EQ(last.peak,
            std::max({read_peaks(out / passage, {3}).at(0).force, read_peaks(out / passage, {4}).at(0).force,
                      read_peaks(out / passage, {5}).at(0).force}));
  EXPECT_NEAR(last.load, 1.2 * last.peak, 0.012 * last.peak);
  EXPECT_NEAR(last.curve.force.back(), last.load, 0.05 * last.load);
  EXPECT_LT(last.curve.secant(), 2e8);  // softer than what lies below it
  for (const char* file : {"bed/summary.json", "bed-1-0/series.csv", "bed-1-1/summary.json", "curve-1-0.csv",
                           "passage-0/sleepers.csv", "passage-1/summary.json"})
    EXPECT_TRUE(fs::exists(out / file)) << file;
  EXPECT_EQ(std::ranges::count(read_file(out / "rounds.csv"), '\n'), 1 + static_cast<long>(rounds.size()));
  // The same bits again.
  run_tiny(again.path);
  EXPECT_EQ(read_file(again.path / "out/rounds.csv"), read_file(out / "rounds.csv"));
}

TEST(Couple, ABedRecordedTooSeldomSaysSo) {
  const TemporaryFolder folder;
  try {
    run_tiny(folder.path, {"bed.set=[\"seed=1\",\"record.every=\\\"1 s\\\"\"]"});
    FAIL() << "two rows are no curve";
  } catch (const RunError& error) {
    const std::string message = error.what();
    EXPECT_NE(message.find("bed-1-0: pressed with"), std::string::npos) << message;
    EXPECT_NE(message.find("recorded 2 times: the sleeper does not sink"), std::string::npos) << message;
    EXPECT_NE(message.find("record.every"), std::string::npos) << message;
  }
}

TEST(Couple, WhatDoesNotFitIsRefusedWithItsPlace) {
  const TemporaryFolder folder;
  const auto message = [&](const std::string& set) -> std::string {
    try {
      run_tiny(folder.path, {set});
    } catch (const InputError& error) {
      return error.what();
    }
    return "nothing wrong";
  };
  const auto expect = [&](const std::string& set, const char* part) {
    EXPECT_NE(message(set).find(part), std::string::npos) << message(set);
  };
  expect("bed.body=slepper", "has no body called slepper");
  expect("bed.stages=[\"pres\"]", "has no stage called pres");
  expect("bed.force=[\"stages.settle.unbalanced_ratio\"]", "is no key of a stage from press on");
  expect("bed.force=[\"stages.press.distance\"]", "distance");
  expect("sleepers.1.to=11", "there is no sleeper 11 on an embankment");
  expect("passage.case=" + (folder.path / "bed.toml").string(), "this is no track case");
}

}  // namespace
}  // namespace trackbed
