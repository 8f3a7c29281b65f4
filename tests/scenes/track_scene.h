// A short track with a coach, for tests.
#pragma once

#include <utility>
#include <vector>

#include "fem/track_model.h"

namespace trackbed::fem {

/// The thesis' track and coach; masses as in cases/transition-zone.
inline TrackInput thesis_track() {
  TrackInput in;
  in.rail = {2.1e11, 2338e-8, 69.77e-4, 7850, 0.4 * 69.77e-4, 0.3, 0};
  in.fastener = {1.2e8, 1.2e11, 5e4};
  in.vehicle = {63.5e3 / 2, 63.5e3 / 2 * 7.85 * 7.85, 2615.0 / 2,     1476.0 / 2, 1813.0 / 2, 20,
                2.5,        {4.2e5, 1.8e4},           {4.7e5, 3.5e4}, 1e4};
  return in;
}

/// The same under a coach so short that few sleepers are enough.
inline TrackInput short_track() {
  TrackInput in = thesis_track();
  in.sleeper.patches = 3;
  in.vehicle.bogie_distance = 6;
  in.vehicle.wheelbase = 2;
  in.vehicle.car_pitch_inertia /= 10;
  return in;
}

/// Sleepers on springs of their own.
inline Zone spring_zone(const TrackInput& in, int sleepers, const Springs& springs = {}) {
  Zone zone;
  zone.sleepers = sleepers;
  zone.ground = make_springs(springs, sleepers, in.sleeper, in.whole_width);
  zone.contact = OneSidedSpring{1.2e9};
  return zone;
}

/// Sleepers on springs, a bridge, sleepers on springs.
inline std::vector<Zone> transition(const TrackInput& in, int before, int on_bridge, int behind,
                                    double settlement) {
  std::vector<Zone> zones;
  zones.push_back(spring_zone(in, before));
  zones.emplace_back();
  zones.back().kind = Zone::Kind::bridge;
  zones.back().sleepers = on_bridge;
  zones.push_back(spring_zone(in, behind));
  for (const std::size_t z : {0U, 2U})
    zones[z].gaps.assign(static_cast<std::size_t>(zones[z].sleepers), settlement);
  return zones;
}

}  // namespace trackbed::fem
