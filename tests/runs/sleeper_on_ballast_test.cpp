// A sleeper pressed on ballast in a short form, through three levels of force.
#include <gtest/gtest.h>

#include <cmath>

#include "expected.h"
#include "io/csv.h"
#include "lab/track/support_curve.h"
#include "scenes/temporary_folder.h"

namespace trackbed {
namespace {

TEST(sleeper_on_ballast, long_short_form_gives_what_the_case_expects) {
  const TemporaryFolder out;
  const Summary summary = run_and_compare("sleeper-on-ballast", out.path);
  const CsvTable levels(out.path / "stages/press-levels.csv");
  ASSERT_EQ(levels.rows(), 3u);
  const auto column = [&](const std::string& name, Dimension dimension) {
    return levels.numbers(name, dimension);
  };
  const auto level = column("level", Dimension::force), force = column("force", Dimension::force),
             distance = column("distance", Dimension::length),
             mean = column("sleeper.contact_force_mean", Dimension::force),
             most = column("sleeper.contact_force_max", Dimension::force),
             contacts = column("sleeper.contacts", Dimension::none);
  for (std::size_t k = 0; k < 3; ++k) {
    EXPECT_GE(force[k], level[k]);
    EXPECT_LT(force[k], 1.01 * level[k]);  // stiffness of the bed x the way of a step
    EXPECT_GT(most[k], mean[k]);
    EXPECT_GT(contacts[k] * mean[k], level[k]);  // magnitudes add up to more than their sum
    EXPECT_LT(contacts[k] * mean[k], 2 * level[k]);
    if (k > 0) {
      EXPECT_GT(distance[k], distance[k - 1]);
      EXPECT_GT(mean[k], mean[k - 1]);
    }
  }
  // The last row is the state at the end of the stage.
  EXPECT_EQ(most[2], value_of(stage_of(summary, "press").measures, "sleeper.contact_force_max"));

  PressHistory history;
  const CsvTable series(out.path / "series.csv");
  const auto stage = series.texts("stage");
  const auto height = series.numbers("sleeper.displacement_z", Dimension::length),
             pressed = series.numbers("sleeper.force_z", Dimension::force);
  for (std::size_t k = 0; k < stage.size(); ++k)
    if (stage[k] == "press" || stage[k] == "lift") {
      history.sinking.push_back(-height[k]);
      history.force.push_back(pressed[k]);
    }
  const SupportCurve curve = support_curve(history);
  EXPECT_GT(curve.unloading, curve.secant());
  EXPECT_NEAR(curve.force.back(), 4000, 40);
  EXPECT_NEAR(curve.sinking.back(), distance[2], 0.25 * distance[2]);
}

}  // namespace
}  // namespace trackbed
