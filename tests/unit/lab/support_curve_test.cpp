// The law of a bed out of what was recorded, on histories made by formula.
#include "lab/track/support_curve.h"

#include <gtest/gtest.h>

#include <cmath>

#include "base/error.h"
#include "io/files.h"
#include "scenes/temporary_folder.h"

namespace trackbed {
namespace {

/// A straight way to a point in `n` rows.
void go(PressHistory& h, double sinking, double force, int n) {
  const double s = h.sinking.empty() ? 0 : h.sinking.back(), f = h.force.empty() ? 0 : h.force.back();
  for (int k = h.force.empty() ? 0 : 1; k <= n; ++k) {
    h.sinking.push_back(std::lerp(s, sinking, double(k) / n));
    h.force.push_back(std::lerp(f, force, double(k) / n));
  }
}

TEST(SupportCurve, OneLoadOfALine) {
  PressHistory h;
  go(h, 1e-3, 80e3, 37);  // 8e7 N/m
  go(h, 0.6e-3, 0, 11);   // 2e8 N/m back
  const SupportCurve curve = support_curve(h, 10);
  ASSERT_EQ(curve.force.size(), 11u);
  for (std::size_t k = 0; k < curve.force.size(); ++k)
    EXPECT_NEAR(curve.force[k], 8e7 * curve.sinking[k], 1e-6 * 80e3);
  EXPECT_NEAR(curve.force.back(), 80e3, 1e-9);
  EXPECT_NEAR(curve.unloading, 2e8, 1e-6 * 2e8);
  EXPECT_EQ(curve.settlement, 0);
  EXPECT_NEAR(curve.secant(), 8e7, 1);
  const fem::MeasuredSupport half = half_of(curve);
  EXPECT_NO_THROW(fem::check(fem::LinkLaw(half)));
  EXPECT_NEAR(half.force.back(), 40e3, 1e-9);
  EXPECT_NEAR(half.unloading, 1e8, 100);
}

// A rise that begins under a small force far down is led back to none by a piece as steep as unloading: but
// for rounding, which the law must allow.
TEST(SupportCurve, ARiseFromASmallForceMakesALaw) {
  for (const double start : {0.1, 1.0, 5.0, 10.0, 77.0})
    for (const double deep : {1e-3, 5e-3, 8e-3}) {
      const PressHistory h{{deep, deep + 1e-3, deep + 0.8e-3}, {start, 50e3, 20e3}};
      EXPECT_NO_THROW(fem::check(fem::LinkLaw(half_of(support_curve(h))))) << start << " N at " << deep;
    }
}

// Each load to 80 kN leaves less: 0.4, 0.2, 0.1 mm; the fourth counts, from 0.7 mm on.
TEST(SupportCurve, TheLastOfManyLoadsCountsAndWhatWasSunkBeforeIsSettlement) {
  PressHistory h;
  double start = 0;
  for (const double left : {0.4e-3, 0.2e-3, 0.1e-3, 0.05e-3}) {
    go(h, start + 0.4e-3 + left, 80e3, 40);
    go(h, start + left, 0, 40);
    start += left;
  }
  const SupportCurve curve = support_curve(h);
  EXPECT_NEAR(curve.settlement, 0.7e-3, 1e-9);
  EXPECT_NEAR(curve.secant(), 80e3 / 0.45e-3, 0.02 * 80e3 / 0.45e-3);
  EXPECT_NEAR(curve.unloading, 2e8, 1e-3 * 2e8);
}

TEST(SupportCurve, ASleeperThatRestsOnTheBedIsLedBackToNoForce) {
  PressHistory h;
  h.sinking = {0.01e-3};
  h.force = {4e3};
  go(h, 0.4e-3, 82e3, 30);  // 2e8 N/m from under 4 kN on
  go(h, 0.2e-3, 2e3, 10);   // 4e8 N/m
  const SupportCurve curve = support_curve(h);
  EXPECT_EQ(curve.force.front(), 0);
  EXPECT_EQ(curve.sinking.front(), 0);
  EXPECT_NEAR(curve.sinking.back(), 4e3 / 4e8 + 0.39e-3, 1e-9);
  EXPECT_EQ(curve.settlement, 0);
}

TEST(SupportCurve, TheWayToTheFirstTouchIsNoSettlement) {
  PressHistory h;
  go(h, 3e-3, 0, 10);
  go(h, 3.4e-3, 80e3, 40);
  EXPECT_EQ(support_curve(h).settlement, 0);
  EXPECT_NEAR(support_curve(h).secant(), 2e8, 1e-6 * 2e8);
}

// A bed that stiffens, unloaded not far enough to tell: unloading is as steep as its steepest part.
// A sleeper that hangs 2 mm above the bed when it is lowered again: its way through the air is not of the
// curve.
TEST(SupportCurve, ASleeperThatHungAboveTheBedBeginsWhereItTouches) {
  PressHistory h;
  h.sinking = {-3e-3, 0};  // and so it does at first
  h.force = {0, 0};
  go(h, 0.5e-3, 80e3, 40);
  go(h, 0.2e-3, 0, 40);
  go(h, -1.8e-3, -10, 40);
  go(h, 0.2e-3, -10, 40);
  go(h, 0.5e-3, 80e3, 40);
  const SupportCurve curve = support_curve(h);
  EXPECT_NEAR(curve.settlement, 0.2e-3, 1e-6);
  EXPECT_NEAR(curve.sinking.back(), 0.3e-3, 1e-6);
  EXPECT_NEAR(curve.force[10], 40e3, 1e-6 * 80e3);
  EXPECT_NEAR(curve.sinking[10], 0.15e-3, 1e-6);
}

TEST(SupportCurve, WithoutUnloadingItIsElasticAtItsSteepest) {
  PressHistory h;
  for (int k = 0; k <= 1000; ++k) {
    const double s = 1e-6 * k;
    h.sinking.push_back(s);
    h.force.push_back(8e10 * s * s);
  }
  const SupportCurve curve = support_curve(h, 20);
  const std::size_t end = curve.force.size() - 1;
  const double last =
      (curve.force[end] - curve.force[end - 1]) / (curve.sinking[end] - curve.sinking[end - 1]);
  EXPECT_NEAR(curve.unloading, last, 1e-9 * last);
  const double touches = std::sqrt(0.002 * 80e3 / 8e10);  // where the rise begins
  EXPECT_NEAR(last, 1.6e8, 0.05 * 1.6e8);
  for (std::size_t k = 0; k < curve.force.size(); ++k)
    EXPECT_NEAR(curve.force[k], 8e10 * std::pow(curve.sinking[k] + touches, 2), 0.01 * 80e3);
  EXPECT_NO_THROW(fem::check(fem::LinkLaw(half_of(curve))));
}

TEST(SupportCurve, WhatShakesStillGivesALaw) {
  PressHistory h;
  for (int k = 0; k <= 5000; ++k) {
    h.sinking.push_back(2e-7 * k + 3e-6 * std::sin(0.7 * k));
    h.force.push_back(80e3 * std::pow(k / 5000.0, 1.5) + 2e3 * std::sin(1.1 * k));
  }
  EXPECT_NO_THROW(fem::check(fem::LinkLaw(half_of(support_curve(h)))));
}

TEST(SupportCurve, AShareOfASleeperOnSomethingThatGives) {
  PressHistory h;
  go(h, 1e-3, 20e3, 10);
  const SupportCurve curve = support_curve(of_whole_sleeper(h, 0.25, 1.6e8));
  EXPECT_NEAR(curve.force.back(), 80e3, 1e-9);
  EXPECT_NEAR(curve.sinking.back(), 1e-3 + 0.5e-3, 1e-12);
}

TEST(SupportCurve, IsReadFromATableInAnyUnits) {
  const TemporaryFolder folder;
  write_file(folder.path / "curve.csv", "force [kN],sinking [mm]\n0,0\n40,0.2\n80,0.4\n");
  const SupportCurve curve = read_support_curve(folder.path / "curve.csv");
  EXPECT_NEAR(curve.secant(), 2e8, 1);
  PressHistory h;
  go(h, 1e-3, 80e3, 7);
  write_history(h, folder.path / "again.csv");
  EXPECT_EQ(read_support_curve(folder.path / "again.csv").sinking, support_curve(h).sinking);
}

TEST(SupportCurve, ABedThatBearsNothingIsRefused) {
  const TemporaryFolder folder;
  const auto message = [&](const char* text) -> std::string {
    write_file(folder.path / "curve.csv", text);
    try {
      read_support_curve(folder.path / "curve.csv");
    } catch (const InputError& error) {
      return error.what();
    }
    return "nothing wrong";
  };
  EXPECT_NE(message("sinking,force\n0,0\n1,0\n").find("curve.csv: the force on the sleeper never grows"),
            std::string::npos);
  EXPECT_NE(message("sinking,force\n1,0\n0,5\n").find("the sleeper does not sink"), std::string::npos);
  EXPECT_NE(message("sinking,load\n1,0\n").find("there is no column force"), std::string::npos);
}

}  // namespace
}  // namespace trackbed
