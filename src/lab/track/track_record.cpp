#include "lab/track/track_record.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "io/files.h"

namespace trackbed {
namespace {

constexpr double nothing = std::numeric_limits<double>::quiet_NaN();
constexpr double open_from = 15, open_to = 27;  // of the open track, before the bridge [m]
constexpr int beside = 25;                      // sleepers that count as beside the bridge
constexpr double touches = 1e-6;                // a sleeper that is nearer does not hang [m]
constexpr std::array zone_names{"lead_in", "approach", "bridge", "departure", "run_out"};

/// Numbers of the sleepers in series.csv when the case names none.
std::vector<double> usual_sleepers() {
  std::vector<double> numbers{-35};
  for (int n = 10; n >= 1; --n) numbers.push_back(-n);
  for (int n = 1; n <= 10; ++n) numbers.push_back(n);
  return numbers;
}

/// Those beyond lie on springs of their own.
bool is_on_embankment(const SleeperRecord& s) {
  return s.zone == static_cast<int>(TrackZone::approach) || s.zone == static_cast<int>(TrackZone::departure);
}

/// Largest forces of the sleepers of a zone that lie so far before the bridge that it tells nothing there.
std::vector<double> open_track(const std::vector<SleeperRecord>& sleepers, TrackZone zone) {
  std::vector<double> peaks;
  const auto first = std::ranges::find(sleepers, -1, &SleeperRecord::number);
  if (first == sleepers.end()) return peaks;
  for (const SleeperRecord& s : sleepers)
    if (s.zone == static_cast<int>(zone) && first->x - s.x >= open_from && first->x - s.x <= open_to)
      peaks.push_back(s.peak_force);
  return peaks;
}

}  // namespace

TrackRecorder::TrackRecorder(const fem::TrackModel& track, const TrackCaseInput& in,
                             std::filesystem::path folder)
    : in_(in),
      folder_(std::move(folder)),
      last_velocity_(track.supports().size(), 0),
      wheel_least_(std::numeric_limits<double>::infinity()),
      speed_from_(in.train.speed_up) {
  int k = 0;
  for (const auto& support : track.supports()) {
    SleeperRecord sleeper;
    sleeper.number = sleeper_number(in.track, k++);
    sleeper.x = support.x - approach_start(in.track);
    sleeper.zone = support.zone;
    sleepers_.push_back(sleeper);
  }
  std::vector<Column> columns{{"time", Dimension::time},           {"first_wheel", Dimension::length},
                              {"wheel_force_1", Dimension::force}, {"wheel_force_2", Dimension::force},
                              {"wheel_force_3", Dimension::force}, {"wheel_force_4", Dimension::force}};
  for (const double number : in.record.sleepers.empty() ? usual_sleepers() : in.record.sleepers) {
    const auto found = std::ranges::find(sleepers_, static_cast<int>(number), &SleeperRecord::number);
    if (found == sleepers_.end()) continue;  // of the usual ones a short track lacks some
    shown_.push_back(static_cast<std::size_t>(found - sleepers_.begin()));
    columns.push_back({fmt::format("sleeper_{:+d}.force", found->number), Dimension::force});
    columns.push_back({fmt::format("sleeper_{:+d}.displacement", found->number), Dimension::length});
  }
  series_.emplace(folder_ / "series.csv", std::move(columns));
  if (in.record.paraview_every) {
    make_folder(folder_ / "paraview" / "frames");
    frames_.emplace(folder_ / "paraview" / "track.pvd");
  }
}

void TrackRecorder::at_rest(const fem::TrackModel& track) {
  for (std::size_t k = 0; k < sleepers_.size(); ++k) {
    const auto& support = track.supports()[k];
    SleeperRecord& s = sleepers_[k];
    s.rest_force = s.peak_force = track.ground_force(support);
    s.rest_gap = track.gap(support);
    s.peak_fastener = s.least_fastener = track.fastener_force(support);
    s.lowest = s.highest = track.displacement(support.seat);
  }
  add_row(track, journey_of(in_).start);
  if (frames_) add_frame(track, journey_of(in_).start);
}

void TrackRecorder::after_step(const fem::TrackModel& track, double first_wheel) {
  const double time = track.system().time(), dt = in_.numerics.time_step;
  for (std::size_t k = 0; k < sleepers_.size(); ++k) {
    const auto& support = track.supports()[k];
    SleeperRecord& s = sleepers_[k];
    const double force = track.ground_force(support), fastener = track.fastener_force(support);
    if (force > s.peak_force) {
      s.peak_force = force;
      s.peak_time = time;
    }
    s.peak_fastener = std::max(s.peak_fastener, fastener);
    s.least_fastener = std::min(s.least_fastener, fastener);
    const double height = track.displacement(support.seat), velocity = track.velocity(support.seat);
    s.lowest = std::min(s.lowest, height);
    s.highest = std::max(s.highest, height);
    if (time > speed_from_)
      s.peak_acceleration = std::max(s.peak_acceleration, std::abs(velocity - last_velocity_[k]) / dt);
    last_velocity_[k] = velocity;
  }
  for (int wheel = 0; wheel < 4; ++wheel) {
    const double force = track.wheel_force(wheel);
    wheel_most_ = std::max(wheel_most_, force);
    wheel_least_ = std::min(wheel_least_, force);
    if (force <= 0) wheels_off_ += dt;
  }
  if (time >= row_due_) add_row(track, first_wheel);
  if (frames_ && time >= frame_due_) add_frame(track, first_wheel);
}

void TrackRecorder::add_row(const fem::TrackModel& track, double first_wheel) {
  std::vector<double> row{track.system().time(), first_wheel};
  for (int wheel = 0; wheel < 4; ++wheel) row.push_back(track.wheel_force(wheel));
  for (const std::size_t k : shown_) {
    row.push_back(track.ground_force(track.supports()[k]));
    row.push_back(track.displacement(track.supports()[k].seat));
  }
  series_->add_row(row);
  row_due_ = track.system().time() + in_.record.every - 1e-9;
}

void TrackRecorder::add_frame(const fem::TrackModel& track, double first_wheel) {
  const std::filesystem::path file =
      folder_ / "paraview" / "frames" / fmt::format("track-{:05}.vtp", frames_->entries().size());
  write_vtp(file, track_picture(track, in_, first_wheel, in_.record.paraview_scale));
  frames_->add(track.system().time(), file);
  frame_due_ = track.system().time() + *in_.record.paraview_every - 1e-9;
}

void TrackRecorder::write_sleepers() const {
  CsvWriter table(folder_ / "sleepers.csv", {{"number"},
                                             {"zone", Dimension::none, true},
                                             {"x", Dimension::length},
                                             {"rest_force", Dimension::force},
                                             {"rest_gap", Dimension::length},
                                             {"peak_force", Dimension::force},
                                             {"peak_time", Dimension::time},
                                             {"peak_fastener_force", Dimension::force},
                                             {"least_fastener_force", Dimension::force},
                                             {"lowest", Dimension::length},
                                             {"highest", Dimension::length},
                                             {"peak_acceleration", Dimension::acceleration}});
  for (const SleeperRecord& s : sleepers_) {
    const std::vector<Cell> row{double(s.number),
                                std::string_view(zone_names.at(static_cast<std::size_t>(s.zone))),
                                s.x,
                                s.rest_force,
                                s.rest_gap,
                                s.peak_force,
                                s.peak_time,
                                s.peak_fastener,
                                s.least_fastener,
                                s.lowest,
                                s.highest,
                                s.peak_acceleration};
    table.add_row(row);
  }
}

std::vector<Result> TrackRecorder::close(const fem::TrackModel& track) {
  write_sleepers();
  std::vector<Result> found = measures_of(sleepers_);
  const fem::SystemEnergy energy = track.system().energy();
  found.push_back({"wheel_force_max", wheel_most_, Dimension::force});
  found.push_back({"wheel_force_min", wheel_least_, Dimension::force});
  found.push_back({"wheels_off_time", wheels_off_, Dimension::time});
  found.push_back({"energy_put_in", energy.put_in, Dimension::energy});
  found.push_back({"energy_damped", energy.parts.damped + energy.links_damped, Dimension::energy});
  found.push_back({"energy_damped_by_step", energy.parts.numerical, Dimension::energy});
  return found;
}

std::vector<Result> measures_of(const std::vector<SleeperRecord>& sleepers) {
  std::vector<double> open = open_track(sleepers, TrackZone::approach);
  if (open.empty()) open = open_track(sleepers, TrackZone::lead_in);
  double middle = nothing, spread = nothing;
  if (!open.empty()) {
    std::ranges::sort(open);
    middle = open[open.size() / 2];
    spread = open.back() - open.front();
  }
  std::vector<Result> found{{"open_track.peak_force", middle, Dimension::force},
                            {"open_track.peak_force_range", spread, Dimension::force}};
  for (const int side : {-1, 1}) {
    const SleeperRecord* most = nullptr;
    double hanging = 0, gap = 0, raised_from = nothing, raised_to = nothing, acceleration = 0;
    for (int n = 1; n <= beside; ++n) {
      const auto s = std::ranges::find(sleepers, side * n, &SleeperRecord::number);
      if (s == sleepers.end() || !is_on_embankment(*s)) continue;
      if (!most || s->peak_force > most->peak_force) most = &*s;
      if (s->rest_gap > touches) ++hanging;
      gap = std::max(gap, s->rest_gap);
      acceleration = std::max(acceleration, s->peak_acceleration);
      if (s->peak_force > 1.05 * middle) {
        if (!(raised_from == raised_from)) raised_from = n;
        raised_to = n;
      }
    }
    const std::string name = side < 0 ? "approach" : "departure";
    found.push_back({name + ".peak_force", most ? most->peak_force : nothing, Dimension::force});
    found.push_back({name + ".peak_sleeper", most ? most->number : nothing, Dimension::none});
    found.push_back({name + ".raised_from", side * raised_from, Dimension::none});
    found.push_back({name + ".raised_to", side * raised_to, Dimension::none});
    found.push_back({name + ".hanging_sleepers", hanging, Dimension::none});
    found.push_back({name + ".largest_gap", gap, Dimension::length});
    found.push_back({name + ".peak_acceleration", acceleration, Dimension::acceleration});
  }
  return found;
}

}  // namespace trackbed
