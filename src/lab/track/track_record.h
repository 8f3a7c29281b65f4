// What a train's passage leaves: extremes of every sleeper, a series of forces, frames for ParaView.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "io/csv.h"
#include "io/vtk.h"
#include "lab/stage.h"
#include "lab/track/track_case.h"

namespace trackbed {

/// Extremes of one sleeper, or of one fastening on the bridge, in whole (both rails).
struct SleeperRecord {
  int number = 0;                                // from the bridge; 0 on it
  double x = 0;                                  // from the start of the approach [m]
  int zone = 0;                                  // a TrackZone
  double rest_force = 0;                         // on the ground, before the train moves [N]
  double rest_gap = 0;                           // [m]
  double peak_force = 0;                         // on the ground [N]
  double peak_time = 0;                          // [s]
  double peak_fastener = 0, least_fastener = 0;  // of both fastenings [N]
  double lowest = 0, highest = 0;                // under the rail [m]
  double peak_acceleration = 0;                  // there [m/s^2]
};

class TrackRecorder {
 public:
  TrackRecorder(const fem::TrackModel& track, const TrackCaseInput& in, std::filesystem::path folder);

  /// Before the train moves.
  void at_rest(const fem::TrackModel& track);
  /// After each step; first_wheel from the start of the approach [m].
  void after_step(const fem::TrackModel& track, double first_wheel);
  /// Writes sleepers.csv; returns the measures of the passage.
  std::vector<Result> close(const fem::TrackModel& track);

  const std::vector<SleeperRecord>& sleepers() const { return sleepers_; }

 private:
  void add_row(const fem::TrackModel& track, double first_wheel);
  void add_frame(const fem::TrackModel& track, double first_wheel);
  void write_sleepers() const;

  TrackCaseInput in_;
  std::filesystem::path folder_;
  std::vector<SleeperRecord> sleepers_;
  std::vector<std::size_t> shown_;  // those of series.csv
  std::vector<double> last_velocity_;
  std::optional<CsvWriter> series_;
  std::optional<TimeSeries> frames_;
  double row_due_ = 0, frame_due_ = 0;                        // [s]
  double wheel_most_ = 0, wheel_least_ = 0, wheels_off_ = 0;  // [N], [N], [s]
  double speed_from_ = 0;                                     // when the train has its speed [s]
};

/// The track as surfaces and lines, displacements drawn `scale` times; the train with it.
PolyData track_picture(const fem::TrackModel& track, const TrackCaseInput& in, double first_wheel,
                       double scale);

/// What the sleepers' extremes say: forces in the open track and beside the bridge, hanging sleepers.
std::vector<Result> measures_of(const std::vector<SleeperRecord>& sleepers);

}  // namespace trackbed
