#include "io/progress.h"

#include <gtest/gtest.h>

#include <vector>

namespace trackbed {
namespace {

using namespace std::chrono_literals;

/// All that `use` prints.
template <class Use>
std::string printed(Progress::Style style, const Use& use) {
  std::FILE* file = std::tmpfile();
  const Progress::Clock::time_point start{};
  Progress progress(file, style, start);
  use(progress, start);
  std::string text(static_cast<std::size_t>(std::ftell(file)), ' ');
  std::rewind(file);
  text.resize(std::fread(text.data(), 1, text.size(), file));
  std::fclose(file);
  return text;
}

void ten_seconds(Progress& progress, Progress::Clock::time_point start) {
  for (std::uint64_t step = 1; step <= 10'000; ++step)
    progress.update({"1/2 fill", 1e-4 * double(step), step, 500, double(step) / 20'000, 0.1},
                    start + step * 1ms);
  progress.end_stage({"1/2 fill", 1.0, 10'000, 500, 0.5, 0.1}, start + 10s);
}

TEST(Progress, FewPlainLinesForAPipe) {
  EXPECT_EQ(printed(Progress::Style::lines, ten_seconds),
            "1/2 fill  t = 0.5 s  1e+03 steps/s  500 contacts  25 %, 15 s left\n"
            "1/2 fill  t = 1 s  1e+03 steps/s  500 contacts  50 %, 10 s left\n"
            "1/2 fill  t = 1 s  1e+03 steps/s  500 contacts  done in 10 s\n");
}

TEST(Progress, AResumedStageIsJudgedByWhatWasDoneSince) {
  const auto resumed = [](Progress& progress, Progress::Clock::time_point start) {
    for (std::uint64_t step = 1; step <= 5'000; ++step)
      progress.update({"push", 1.0, step, 500, 0.45 + double(step) / 100'000, 0.1}, start + step * 1ms);
  };
  EXPECT_EQ(printed(Progress::Style::lines, resumed),
            "push  t = 1 s  1e+03 steps/s  500 contacts  50 %, 50 s left\n");
}

TEST(Progress, OneLineInPlaceOnATerminal) {
  const std::string text = printed(Progress::Style::terminal, ten_seconds);
  EXPECT_EQ(std::count(text.begin(), text.end(), '\r'), 51);  // 5 in a second, and the last
  EXPECT_EQ(std::count(text.begin(), text.end(), '\n'), 1);
  EXPECT_TRUE(text.ends_with("done in 10 s\x1b[K\n"));
}

TEST(Progress, SaysWhatTakesLong) {
  const auto say = [](Progress& progress, Progress::Clock::time_point) { progress.say("some minutes"); };
  EXPECT_EQ(printed(Progress::Style::lines, say), "some minutes\n");
  EXPECT_EQ(printed(Progress::Style::terminal, say), "\rsome minutes\x1b[K\n");
  EXPECT_EQ(printed(Progress::Style::quiet, say), "");
}

TEST(Progress, QuietIsQuiet) {
  EXPECT_EQ(printed(Progress::Style::quiet, ten_seconds), "");
}

TEST(Progress, AFileIsNoTerminal) {
  std::FILE* file = std::tmpfile();
  EXPECT_EQ(Progress::style_of(file), Progress::Style::lines);
  std::fclose(file);
}

TEST(Progress, HintWhenTheSearchIsDear) {
  EXPECT_EQ(progress_line({"settle", 0.25, 10, 7, 0, 0.35}, 1234, 3),
            "settle  t = 0.25 s  1.23e+03 steps/s  7 contacts  (search 35 %: a larger skin may help)");
}

TEST(Progress, TellsWhatAStageWaitsFor) {
  EXPECT_EQ(progress_line({"rest", 0.25, 10, 7, 0, 0, {"unbalanced ratio", 0.00421, 0.001}}, 100, 3),
            "rest  t = 0.25 s  100 steps/s  7 contacts  unbalanced ratio 0.00421, 0.001 wanted");
  EXPECT_EQ(progress_line({"down", 0.25, 10, 7, 0, 0, {"force", 12.34, 500, Dimension::force}}, 100, 3),
            "down  t = 0.25 s  100 steps/s  7 contacts  force 12.3 N, 500 N wanted");
}

TEST(Progress, Durations) {
  EXPECT_EQ(duration_text(8.4), "8 s");
  EXPECT_EQ(duration_text(200), "3 min 20 s");
  EXPECT_EQ(duration_text(7500), "2 h 05 min");
  EXPECT_EQ(duration_text(1e300), "very long");
}

}  // namespace
}  // namespace trackbed
