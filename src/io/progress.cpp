#include "io/progress.h"

#include <fmt/format.h>
#include <unistd.h>

#include <cmath>

namespace trackbed {
namespace {

double seconds_between(Progress::Clock::time_point from, Progress::Clock::time_point to) {
  return std::chrono::duration<double>(to - from).count();
}

/// "12.3 N"
std::string text_of(double value, Dimension dimension) {
  const std::string number = fmt::format("{:.3g}", value);
  return dimension == Dimension::none ? number : fmt::format("{} {}", number, si_unit_of(dimension));
}

}  // namespace

std::string duration_text(double seconds) {
  if (!(seconds < 1e9)) return "very long";
  const auto s = static_cast<long>(std::lround(seconds));
  if (s < 60) return fmt::format("{} s", s);
  if (s < 3600) return fmt::format("{} min {:02} s", s / 60, s % 60);
  return fmt::format("{} h {:02} min", s / 3600, s % 3600 / 60);
}

std::string progress_line(const ProgressState& state, double steps_per_second, double seconds_left) {
  std::string line = fmt::format("{}  t = {:.4g} s  {:.3g} steps/s  {} contacts", state.stage, state.time,
                                 steps_per_second, state.contacts);
  if (state.fraction_done > 0 && state.fraction_done < 1)
    line += fmt::format("  {:.0f} %, {} left", 100 * state.fraction_done, duration_text(seconds_left));
  if (const Awaited& a = state.awaited; !a.quantity.empty())
    line += fmt::format("  {} {}, {} wanted", a.quantity, text_of(a.now, a.dimension),
                        text_of(a.wanted, a.dimension));
  if (state.search_share > 0.3)
    line += fmt::format("  (search {:.0f} %: a larger skin may help)", 100 * state.search_share);
  return line;
}

Progress::Style Progress::style_of(std::FILE* out) {
  if (!out) return Style::quiet;
  return ::isatty(::fileno(out)) ? Style::terminal : Style::lines;
}

Progress::Progress(std::FILE* out, Style style, Clock::time_point start)
    : out_(out), style_(style), stage_start_(start), printed_(start), rate_from_(start) {}

void Progress::update(const ProgressState& state, Clock::time_point now) {
  if (style_ == Style::quiet) return;
  if (fraction_at_start_ < 0) fraction_at_start_ = state.fraction_done;
  const double period = style_ == Style::terminal ? 0.2 : 5.0;  // [s]
  const double passed = seconds_between(printed_, now);
  if (passed < period) return;
  rate_ = static_cast<double>(state.steps - steps_at_rate_) / seconds_between(rate_from_, now);
  steps_at_rate_ = state.steps;
  rate_from_ = printed_ = now;
  // What is left takes as long, for its part, as what was done here took.
  const double done = state.fraction_done - fraction_at_start_;
  const double left = seconds_between(stage_start_, now) * (1 - state.fraction_done) / done;
  print(progress_line(state, rate_, left), false);
}

void Progress::say(const std::string& line) {
  if (style_ != Style::quiet) print(line, true);
}

void Progress::end_stage(const ProgressState& state, Clock::time_point now) {
  const double seconds = seconds_between(stage_start_, now);
  const double since_rate = seconds_between(rate_from_, now);
  if (since_rate > 0) rate_ = static_cast<double>(state.steps - steps_at_rate_) / since_rate;
  stage_start_ = rate_from_ = printed_ = now;
  steps_at_rate_ = state.steps;
  fraction_at_start_ = -1;
  if (style_ == Style::quiet) return;
  ProgressState done = state;
  done.fraction_done = 1;
  done.awaited = {};
  print(progress_line(done, rate_, 0) + "  done in " + duration_text(seconds), true);
}

void Progress::print(const std::string& line, bool keep) {
  // \r to the start of the line, \x1b[K erases what the longer line before has left.
  if (style_ == Style::terminal)
    fmt::print(out_, "\r{}\x1b[K{}", line, keep ? "\n" : "");
  else
    fmt::print(out_, "{}\n", line);
  std::fflush(out_);
}

}  // namespace trackbed
