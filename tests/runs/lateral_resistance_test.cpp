// The lateral push in a short form: few, large and soft stones, 2 mm.
#include <gtest/gtest.h>

#include <cmath>

#include "expected.h"
#include "scenes/temporary_folder.h"

namespace trackbed {
namespace {

/// What keeps the sleeper at its speed puts in the work that the bed takes up.
void energy_balance_of_the_push_closes(const StageSummary& rest, const StageSummary& push) {
  const double work = value_of(push.measures, "boundary_work") - value_of(rest.measures, "boundary_work");
  EXPECT_GT(work, 0);
  EXPECT_LT(std::abs(push.energy_error), 1e-3 * work);
}

/// Base, crib and shoulder bear the whole force; without dashpots all of it is elastic.
void parts_make_the_whole(const StageSummary& push) {
  double parts = 0;
  for (const char* part : {"base", "sides", "ends"})
    parts += value_of(push.measures, std::string("sleeper.force_") + part + "_x");
  const double whole = value_of(push.measures, "sleeper.force_x");
  EXPECT_LT(whole, 0);
  EXPECT_NEAR(parts, whole, 1e-6 * std::abs(whole));
}

TEST(lateral_resistance, short_form_gives_what_the_case_expects) {
  const TemporaryFolder out;
  const Summary summary = run_and_compare("lateral-resistance", out.path);
  const StageSummary &rest = stage_of(summary, "rest"), &push = stage_of(summary, "push");
  const double weight = 40 * 9.81;  // of the short sleeper [N]
  EXPECT_NEAR(value_of(rest.measures, "sleeper.force_z"), weight, 0.01 * weight);
  energy_balance_of_the_push_closes(rest, push);
  parts_make_the_whole(push);
  EXPECT_EQ(value_of(stage_of(summary, "replace").results, "replaced") +
                value_of(stage_of(summary, "replace").results, "left"),
            value_of(summary.measures, "stones"));
  EXPECT_GE(value_of(push.results, "force_peak"), value_of(push.results, "force_at_1_mm"));
}

}  // namespace
}  // namespace trackbed
