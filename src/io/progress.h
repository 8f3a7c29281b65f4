// How a run is getting on, in one line.
#pragma once

#include <chrono>
#include <cstdint>
#include <cstdio>
#include <string>
#include <string_view>

#include "base/units.h"

namespace trackbed {

/// What a stage waits for, where that is not a time.
struct Awaited {
  std::string_view quantity;  // "unbalanced ratio"; empty: nothing, or it was not looked at yet
  double now = 0, wanted = 0;
  Dimension dimension = Dimension::none;
};

/// What the line tells.
struct ProgressState {
  std::string stage;           // "2/5 settle"
  double time = 0.0;           // simulated [s]
  std::uint64_t steps = 0;     // since the run began
  std::uint64_t contacts = 0;  // in touch now
  double fraction_done = 0.0;  // of the stage, 0 .. 1; 0: not known
  double search_share = 0.0;   // of the wall time that went into the contact search, 0 .. 1
  Awaited awaited{};
};

/// Prints the line to a terminal, over and over in place; to a pipe or file as plain lines, few of them.
class Progress {
 public:
  enum class Style { terminal, lines, quiet };
  using Clock = std::chrono::steady_clock;

  /// terminal or lines, as `out` is one or the other; quiet where it is nothing.
  static Style style_of(std::FILE* out);

  explicit Progress(std::FILE* out) : Progress(out, style_of(out)) {}

  /// `out` must live as long; not used when quiet.
  Progress(std::FILE* out, Style style, Clock::time_point start = Clock::now());

  /// Call it at every step: it looks at the clock, and prints when it is time to (terminal: 0.2 s, lines: 5
  /// s).
  void update(const ProgressState& state, Clock::time_point now = Clock::now());
  /// A line that stays, of what takes long without steps.
  void say(const std::string& line);
  /// Closes a stage: its last line stays.
  void end_stage(const ProgressState& state, Clock::time_point now = Clock::now());

 private:
  void print(const std::string& line, bool keep);

  std::FILE* out_;
  Style style_;
  Clock::time_point stage_start_, printed_, rate_from_;
  std::uint64_t steps_at_rate_ = 0;
  double rate_ = 0.0;                // [steps/s], of the time since the line before
  double fraction_at_start_ = -1.0;  // of the stage, where this run took it up; negative: not told yet
};

/// "load  t = 0.25 s  1.2e3 steps/s  5400 contacts  40 %, 12 s left  (search 35 %: a larger skin may help)",
/// "rest  t = 0.25 s  1.2e3 steps/s  5400 contacts  unbalanced ratio 0.0042, 0.001 wanted"
std::string progress_line(const ProgressState& state, double steps_per_second, double seconds_left);

/// "8 s", "3 min 20 s", "2 h 05 min"
std::string duration_text(double seconds);

}  // namespace trackbed
