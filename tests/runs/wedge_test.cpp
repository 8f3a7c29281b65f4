// The wedge sleepers in short forms, in the box and in the plane.
#include <gtest/gtest.h>

#include <cmath>

#include "expected.h"
#include "scenes/temporary_folder.h"

namespace trackbed {
namespace {

/// What drives the sleeper puts in the work that the bed takes up.
void energy_balance_closes(const Summary& summary, const std::string& before, const std::string& stage) {
  const double work = value_of(stage_of(summary, stage).measures, "boundary_work") -
                      value_of(stage_of(summary, before).measures, "boundary_work");
  EXPECT_NE(work, 0) << stage;
  EXPECT_LT(std::abs(stage_of(summary, stage).energy_error), 2e-3 * std::abs(work)) << stage;
}

/// Slopes, base, sides and ends bear the whole force; without dashpots all of it is elastic.
void faces_make_the_whole(const StageSummary& stage) {
  double parts = 0;
  for (const char* part : {"base", "slopes", "sides", "ends"})
    parts += value_of(stage.measures, std::string("sleeper.force_") + part + "_z");
  const double whole = value_of(stage.measures, "sleeper.force_z");
  EXPECT_GT(whole, 0);
  EXPECT_NEAR(parts, whole, 1e-6 * whole);
}

TEST(wedge_3d, short_form_gives_what_the_case_expects) {
  const TemporaryFolder out;
  const Summary summary = run_and_compare("wedge-3d", out.path);
  faces_make_the_whole(stage_of(summary, "lower"));
  energy_balance_closes(summary, "hold", "lower");
}

TEST(wedge_2d, short_form_gives_what_the_case_expects) {
  const TemporaryFolder out;
  const Summary summary = run_and_compare("wedge-2d", out.path);
  faces_make_the_whole(stage_of(summary, "load"));
  energy_balance_closes(summary, "loads", "load");
  // At rest floor, sides and sleeper bear the stones; the sleeper, which is moved, bears itself.
  const StageSummary& rest = stage_of(summary, "rest");
  double borne = 0;
  for (const char* wall : {"box.floor", "box.left", "box.right", "sleeper"})
    borne -= value_of(rest.measures, std::string(wall) + ".force_z");
  const double sleeper = 2500 * 0.250 * (0.150 + 0.125 / 2) * 9.81;
  const double stones = value_of(rest.measures, "weight") - sleeper;
  EXPECT_NEAR(borne, stones, 0.01 * stones);
}

}  // namespace
}  // namespace trackbed
