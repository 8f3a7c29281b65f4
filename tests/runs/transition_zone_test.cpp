// The transition zone in a short form.
#include <gtest/gtest.h>

#include <cmath>

#include "expected.h"
#include "scenes/temporary_folder.h"

namespace trackbed {
namespace {

TEST(transition_zone, short_form_gives_what_the_case_expects) {
  const TemporaryFolder folder;
  run_and_compare("transition-zone", folder.path);
}

TEST(transition_zone, wheels_that_leave_the_rails_over_a_deep_hole_are_told) {
  const TemporaryFolder folder;
  const Summary deep = run_short_form("transition-zone", folder.path, {"track.settlement=200 mm"});
  EXPECT_GT(value_of(deep.measures, "wheels_off_time"), 0.01);
  EXPECT_EQ(value_of(deep.measures, "wheel_force_min"), 0);
  for (const Result& measure : deep.measures) EXPECT_TRUE(std::isfinite(measure.value)) << measure.name;
}

TEST(transition_zone, ground_that_has_heaved_bears_the_train_beside_the_bridge) {
  const TemporaryFolder folder;
  const Summary heaved = run_short_form("transition-zone", folder.path, {"track.settlement=-10 mm"});
  EXPECT_EQ(value_of(heaved.measures, "approach.peak_sleeper"), -1);
  EXPECT_EQ(value_of(heaved.measures, "departure.peak_sleeper"), 1);
  // The rails are bent down to the bridge by the first sleepers, which press far more than their share.
  EXPECT_GT(value_of(heaved.measures, "approach.peak_force"),
            2 * value_of(heaved.measures, "open_track.peak_force"));
  EXPECT_EQ(value_of(heaved.measures, "wheels_off_time"), 0);
}

}  // namespace
}  // namespace trackbed
