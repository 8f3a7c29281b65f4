#include "fem/link_law.h"

#include <gtest/gtest.h>

#include <cmath>
#include <stdexcept>

namespace trackbed::fem {
namespace {

TEST(LinkLaw, HertzIsASphereOnAFlat) {
  const double young = 2.1e11, poisson = 0.3, radius = 0.46;
  const double reduced = young / (2 * (1 - poisson * poisson));  // of two bodies alike
  const double constant = 4.0 / 3 * reduced * std::sqrt(radius), load = 93e3;
  const double approach = std::cbrt(9 * load * load / (16 * reduced * reduced * radius));  // Hertz
  const LinkForce found = force_of(HertzContact{constant}, {}, approach, 0);
  EXPECT_NEAR(found.force, load, 1e-12 * load);
  EXPECT_NEAR(found.stiffness, hertz_stiffness(constant, load), 1e-12 * found.stiffness);
  EXPECT_EQ(force_of(HertzContact{constant}, {}, -1e-6, 0).force, 0);
}

TEST(LinkLaw, SlopesAreThoseOfTheForce) {
  const MeasuredSupport support{{0, 1e-3, 2e-3}, {0, 20e3, 80e3}, 9e7};
  const LinkMemory memory{1.5e-3};
  for (const LinkLaw& law : {LinkLaw{GivenForce{7}}, LinkLaw{ClampedSpring{1.2e8, 1.2e11, 5e4}},
                             LinkLaw{OneSidedSpring{1e8}}, LinkLaw{HertzContact{9e10}}, LinkLaw{support}}) {
    for (const double closing : {-1e-3, 1.45e-3, 1.7e-3, 5e-3}) {
      const double step = 1e-9, rate = 0.1;
      const LinkForce here = force_of(law, memory, closing, rate);
      const double slope = (force_of(law, memory, closing + step, rate).force -
                            force_of(law, memory, closing - step, rate).force) /
                           (2 * step);
      EXPECT_NEAR(here.stiffness, slope, 1e-3 * (1 + std::abs(slope)));
      EXPECT_NEAR(here.damping, (force_of(law, memory, closing, rate + 1).force - here.force), 1e-6);
      const double energy =
          (stored_energy(law, memory, closing + step) - stored_energy(law, memory, closing - step)) /
          (2 * step);
      // Beyond, a measured support does not give all back.
      if (closing < memory.deepest) {
        EXPECT_NEAR(energy, force_of(law, memory, closing, 0).force, 1e-3 * (1 + std::abs(energy)));
      }
    }
  }
}

TEST(LinkLaw, MeasuredSupportUnloadsAndLoadsAgainAlongOneLine) {
  const MeasuredSupport law{{1e-3, 2e-3, 3e-3}, {0, 10e3, 40e3}, 1e8};
  EXPECT_EQ(force_of(law, {}, 1e-3, 0).force, 0);
  EXPECT_NEAR(force_of(law, {}, 2.5e-3, 0).force, 25e3, 1e-8);
  EXPECT_NEAR(force_of(law, {}, 4e-3, 0).force, 70e3, 1e-8);  // beyond the last point
  const LinkMemory loaded{2.5e-3};
  EXPECT_NEAR(force_of(law, loaded, 2.4e-3, 0).force, 15e3, 1e-8);
  EXPECT_EQ(force_of(law, loaded, 2.2e-3, 0).force, 0);
  EXPECT_NEAR(force_of(law, loaded, 2.75e-3, 0).force, 32.5e3, 1e-8);
}

TEST(LinkLaw, RefusesWhatPushesBackwards) {
  EXPECT_THROW(check(ClampedSpring{-1, 1, 0}), std::invalid_argument);
  EXPECT_THROW(check(OneSidedSpring{-1}), std::invalid_argument);
  EXPECT_THROW(check(HertzContact{-1}), std::invalid_argument);
  EXPECT_THROW(check(MeasuredSupport{{0, 1}, {0, -1}, 1}), std::invalid_argument);
  EXPECT_THROW(check(MeasuredSupport{{0, 1}, {0, 10}, 1}), std::invalid_argument);
  EXPECT_NO_THROW(check(MeasuredSupport{{0, 1}, {0, 10}, 10}));
}

}  // namespace
}  // namespace trackbed::fem
