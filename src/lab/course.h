// Stages one after the other, and where that stands.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "base/stopwatch.h"
#include "io/progress.h"
#include "lab/checkpoint.h"
#include "lab/recorder.h"
#include "lab/run.h"
#include "lab/stage_ends.h"
#include "lab/summary.h"

namespace trackbed {

/// Carries stages through, writes down what they do, and keeps where it stands in checkpoints.
class Course {
 public:
  /// All must live as long.
  Course(Simulation& sim, std::vector<NamedStage>& stages, Recorder& recorder, const RunOptions& options,
         Summary& summary);

  /// From the first stage, from where another run stood that was the same so far (stage_ends.h) or, when that
  /// is asked for, from the last checkpoint. Throws InputError when that is of another case.
  void begin();
  /// To the end of the last stage. Throws Stopped and RunError.
  void run();

 private:
  /// What a stage is measured against when it is over.
  struct Start {
    int stones = 0;
    double energy = 0;  // [J]
    std::int64_t step = 0;
    double time = 0;  // [s]
    Conditions before;

    template <class A>
    void archive(A& a) {
      a(stones, energy, step, time, before);
    }
  };

  void run_stage();
  void open();
  void close();
  const ProgressState& progress();
  void look_up();
  void leave_checkpoint(std::size_t stage);
  void take_up(std::string bytes);
  void leave_end();
  void take_over();
  void archive(Archive& a);
  void archive_between(Archive& a);

  Simulation& sim_;
  std::vector<NamedStage>& stages_;
  Recorder& recorder_;
  const RunOptions& options_;
  Summary& summary_;
  Checkpoints checkpoints_;
  StageEnds ends_;
  Progress progress_;
  ProgressState told_;
  std::size_t stage_ = 0;  // that runs, or is next
  bool is_open_ = false;
  Start start_;
  Stopwatch watch_, stage_watch_;
  double stage_wall_ = 0;  // of the stage, before the run was taken up [s]
};

}  // namespace trackbed
