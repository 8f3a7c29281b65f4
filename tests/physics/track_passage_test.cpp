// A coach on a whole track of sleepers on springs: weight, symmetry, sameness along the track, hanging
// sleepers.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "scenes/track_scene.h"

namespace trackbed::fem {
namespace {

constexpr double speed = 40, dt = 5e-4;

/// Rolls the train over the track; it speeds up over 0.2 s. Returns each support's largest force on ground.
std::vector<double> peaks_of(TrackModel& track, double alpha, double from, double to) {
  std::vector<double> peaks(track.supports().size(), 0);
  track.move_by({dt, alpha});
  double x = from, t = 0;
  while (true) {
    const double share = std::min(1.0, (t + 0.5 * dt) / 0.2);
    x += speed * share * share * (3 - 2 * share) * dt;
    t += dt;
    if (x > to) return peaks;
    track.step(x);
    for (std::size_t k = 0; k < peaks.size(); ++k)
      peaks[k] = std::max(peaks[k], track.ground_force(track.supports()[k]));
  }
}

TEST(TrackPassage, RestCarriesAllWeight) {
  const TrackInput in = short_track();
  std::vector<Zone> zones;
  zones.push_back(spring_zone(in, 30));
  TrackModel track(in, std::move(zones));
  track.find_rest(12);
  double carried = 0, wheels = 0;
  for (const auto& s : track.supports()) carried += track.ground_force(s);
  for (int w = 0; w < 4; ++w) wheels += track.wheel_force(w);
  const double rails = 2 * 30 * 0.6 * in.rail.area * in.rail.density * in.gravity;
  EXPECT_NEAR(wheels, in.vehicle.weight(in.gravity), 1e-6 * wheels);
  EXPECT_NEAR(carried, 2 * wheels + rails + 30 * in.sleeper.mass() * in.gravity, 1e-6 * carried);
}

TEST(TrackPassage, HalfTheTrackIsEnough) {
  std::vector<double> of_half, of_whole;
  for (const bool whole : {false, true}) {
    TrackInput in = short_track();
    in.whole_width = whole;
    TrackModel track(in, transition(in, 18, 6, 8, 4e-3));
    const double from = track.first_start() + 0.5;
    track.find_rest(from);
    (whole ? of_whole : of_half) = peaks_of(track, -0.05, from, from + 4);
  }
  const double largest = *std::ranges::max_element(of_half);
  EXPECT_GT(largest, 50e3);
  for (std::size_t k = 0; k < of_half.size(); ++k) EXPECT_NEAR(of_half[k], of_whole[k], 1e-6 * largest) << k;
}

TEST(TrackPassage, SleepersFarFromTheEndsAreAlike) {
  const TrackInput in = short_track();
  std::vector<Zone> zones;
  zones.push_back(spring_zone(in, 60));
  TrackModel track(in, std::move(zones));
  const double from = track.first_start() + 1;
  track.find_rest(from);
  const std::vector<double> peaks = peaks_of(track, -0.05, from, track.last_end() - 1);
  const auto [low, high] = std::minmax_element(peaks.begin() + 32, peaks.begin() + 46);
  EXPECT_GT(*low, 60e3);
  EXPECT_LT(*high / *low, 1.002);
}

TEST(TrackPassage, SleepersHangBesideABridgeWhereGroundHasSettled) {
  const TrackInput in = short_track();
  std::vector<int> hanging;
  for (const double settlement : {0.0, 4e-3, 8e-3}) {
    TrackModel track(in, transition(in, 30, 10, 30, settlement));
    track.find_rest(9);
    const auto& s = track.supports();
    // Behind the bridge: just before the wheels the rail lifts sleepers too.
    hanging.push_back(static_cast<int>(
        std::count_if(s.begin() + 40, s.end(), [&](const auto& one) { return track.gap(one) > 0; })));
    // The first sleeper behind the bridge hangs nearly by the whole settlement, far off ones lie on ground.
    if (settlement > 0) {
      EXPECT_GT(track.gap(s[40]), 0.5 * settlement);
    }
    EXPECT_EQ(track.gap(s[58]), 0);
    for (std::size_t k = 50; k < 62 && settlement == 0; ++k)
      EXPECT_NEAR(track.ground_force(s[k]), track.ground_force(s[56]), 10);
  }
  EXPECT_EQ(hanging[0], 0);
  EXPECT_LT(hanging[1], hanging[2]);
}

TEST(TrackPassage, EnergyIsKeptWhenNothingDamps) {
  TrackInput in = short_track();
  in.fastener.tension = in.fastener.compression;  // stiff springs that open cost energy in each step
  in.fastener.damping = in.vehicle.primary.damping = in.vehicle.secondary.damping = 0;
  Springs springs;
  springs.damping = 0;
  std::vector<Zone> zones;
  zones.push_back(spring_zone(in, 30, springs));
  TrackModel track(in, std::move(zones));
  track.find_rest(10);
  track.move_by({1e-4, 0});
  const SystemEnergy start = track.system().energy();
  double kinetic = 0;
  for (int n = 1; n <= 1500; ++n) {  // to 30 m/s in 0.15 s
    track.step(10 + 0.5 * 200 * std::pow(n * 1e-4, 2));
    kinetic = std::max(kinetic, track.system().energy().parts.kinetic);
  }
  EXPECT_GT(kinetic, 1);
  EXPECT_NEAR(track.system().energy().balance() - start.balance(), 0, 0.01 * kinetic);
  EXPECT_NEAR(track.system().energy().parts.numerical, 0, 1e-6 * kinetic);
}

}  // namespace
}  // namespace trackbed::fem
