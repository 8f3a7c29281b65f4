#include "lab/track/track_run.h"

#include <fmt/format.h>

#include <cmath>
#include <string>

#include "base/hash.h"
#include "base/stopwatch.h"
#include "dem/threads.h"
#include "io/echo.h"
#include "io/files.h"
#include "io/progress.h"
#include "lab/track/track_record.h"

namespace trackbed {
namespace {

/// Where the first wheel is at a time, from where it started [m]: it speeds up smoothly.
double travelled(const TrainInput& train, double time) {
  const double s = std::min(1.0, time / train.speed_up);
  return train.speed * (train.speed_up * s * s * s * (1 - 0.5 * s) + std::max(0.0, time - train.speed_up));
}

/// When it has come so far [s].
double time_of(const TrainInput& train, double distance) {
  double low = 0, high = train.speed_up + 2 * distance / train.speed;
  for (int k = 0; k < 100; ++k) {
    const double middle = 0.5 * (low + high);
    (travelled(train, middle) < distance ? low : high) = middle;
  }
  return high;
}

StageSummary rest(fem::TrackModel& track, const TrackCaseInput& in) {
  const Stopwatch watch;
  track.find_rest(journey_of(in).start + approach_start(in.track));
  StageSummary stage;
  stage.name = stage.kind = "rest";
  stage.wall = watch.seconds();
  return stage;
}

StageSummary passage(fem::TrackModel& track, const TrackCaseInput& in, TrackRecorder& recorder,
                     Progress& progress) {
  const Stopwatch watch;
  const Journey journey = journey_of(in);
  const double duration = time_of(in.train, journey.end - journey.start), dt = in.numerics.time_step;
  const auto steps = static_cast<std::int64_t>(std::floor(duration / dt));
  track.move_by({dt, in.numerics.alpha});
  const double energy = track.system().energy().balance();
  StageSummary stage;
  stage.name = stage.kind = "passage";
  ProgressState state;
  state.stage = "2/2 passage";
  double newton = 0, conjugate = 0;
  for (std::int64_t n = 1; n <= steps; ++n) {
    const double x = journey.start + travelled(in.train, static_cast<double>(n) * dt);
    track.step(x + approach_start(in.track));
    recorder.after_step(track, x);
    newton += track.system().effort().newton;
    conjugate += track.system().effort().conjugate;
    state.time = track.system().time();
    state.steps = static_cast<std::uint64_t>(n);
    state.fraction_done = static_cast<double>(n) / static_cast<double>(steps);
    progress.update(state);
  }
  progress.end_stage(state);
  stage.steps = steps;
  stage.simulated = track.system().time();
  stage.energy_error = track.system().energy().balance() - energy;
  stage.results = {
      {"newton_steps", newton / static_cast<double>(std::max<std::int64_t>(steps, 1)), Dimension::none},
      {"conjugate_steps", conjugate / static_cast<double>(std::max<std::int64_t>(steps, 1)),
       Dimension::none}};
  stage.wall = watch.seconds();
  return stage;
}

}  // namespace

Summary run_track(const Document& document, const TrackCaseInput& in, const RunOptions& options) {
  const Stopwatch watch;
  check_track(document, in);
  Summary summary;
  summary.title = in.title;
  summary.threads = use_threads(options.threads);
  summary.input = echo(in);
  make_folder(options.out);
  std::filesystem::remove(options.out / "summary.json");  // of another run: what follows is not its
  std::FILE* const out = options.quiet ? nullptr : options.progress;
  fem::TrackModel track = make_track(in, options.keep, [&](TrackZone zone) {
    Progress(out).say(fmt::format(
        "1/2 rest  the ground {} the bridge is worked out, some minutes{}",
        zone == TrackZone::approach ? "before" : "behind",
        options.keep.empty() ? std::string() : "; later runs take it from " + options.keep.string()));
  });
  const double ground = watch.seconds();
  TrackRecorder recorder(track, in, options.out);
  Progress progress(out);
  summary.stages.push_back(rest(track, in));
  summary.stages.back().results = {{"ground_wall", ground, Dimension::time}};
  recorder.at_rest(track);
  summary.stages.push_back(passage(track, in, recorder, progress));
  summary.measures = recorder.close(track);
  summary.stages.back().measures = summary.measures;
  Hash hash;
  for (const double u : track.system().displacements()) hash.add(u);
  summary.state_hash = hash.value();
  summary.wall = watch.seconds();
  write_summary(summary, options.out / "summary.json");
  return summary;
}

}  // namespace trackbed
