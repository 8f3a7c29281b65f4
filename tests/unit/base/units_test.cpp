#include "base/units.h"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <clocale>
#include <cmath>
#include <numbers>

namespace trackbed {
namespace {

double si(std::string_view text, Dimension dimension) {
  const auto parsed = parse_quantity(text, dimension);
  if (const auto* problem = std::get_if<std::string>(&parsed)) {
    ADD_FAILURE() << *problem;
    return std::nan("");
  }
  return std::get<double>(parsed);
}

std::string problem(std::string_view text, Dimension dimension) {
  const auto parsed = parse_quantity(text, dimension);
  return std::holds_alternative<std::string>(parsed) ? std::get<std::string>(parsed) : "no problem";
}

constexpr Dimension last_dimension = Dimension::hertz_constant;

TEST(Units, DecimalUnitsGiveTheNearestDouble) {
  EXPECT_EQ(si("300 mm", Dimension::length), 0.3);
  EXPECT_EQ(si("22.4mm", Dimension::length), 0.0224);
  EXPECT_EQ(si("100 um", Dimension::length), 1e-4);
  EXPECT_EQ(si("20 kN", Dimension::force), 20e3);
  EXPECT_EQ(si("2 us", Dimension::time), 2e-6);
  EXPECT_EQ(si("2.63 t/m^3", Dimension::density), 2630.0);
  EXPECT_EQ(si("2.63 g/cm^3", Dimension::density), 2630.0);
  EXPECT_EQ(si("70 GPa", Dimension::stress), 70e9);
  EXPECT_EQ(si("5 N/mm", Dimension::stiffness), 5e3);
  EXPECT_EQ(si("5 kN/mm", Dimension::stiffness), 5e6);
  EXPECT_EQ(si("5 L", Dimension::volume), 5e-3);
  EXPECT_EQ(si("5 kN m", Dimension::moment), 5e3);
}

TEST(Units, OtherUnits) {
  EXPECT_DOUBLE_EQ(si("180 deg", Dimension::angle), std::numbers::pi);
  EXPECT_DOUBLE_EQ(si("30 rpm", Dimension::angular_velocity), std::numbers::pi);
  EXPECT_DOUBLE_EQ(si("90 km/h", Dimension::velocity), 25.0);
  EXPECT_DOUBLE_EQ(si("6 mm/min", Dimension::velocity), 1e-4);
  EXPECT_EQ(si("40 %", Dimension::none), 0.4);
  EXPECT_EQ(si("0.4", Dimension::none), 0.4);
}

TEST(Units, GramOrGravityByDimension) {
  EXPECT_EQ(si("1 g", Dimension::mass), 1e-3);
  EXPECT_EQ(si("1 g", Dimension::acceleration), 9.80665);
  EXPECT_EQ(si("1 g0", Dimension::acceleration), 9.80665);
}

TEST(Units, SpellingsOfOneUnit) {
  for (const char* text : {"2 kg/m^3", "2 kg/m3", "2 kg/m³", "  2\tkg/m^3  ", "+2 kg/m^3"})
    EXPECT_EQ(si(text, Dimension::density), 2.0) << text;
  for (const char* text : {"2 N m", "2 N*m", "2 N·m"}) EXPECT_EQ(si(text, Dimension::moment), 2.0) << text;
  for (const char* text : {"2 um", "2 \u00b5m", "2 \u03bcm"})
    EXPECT_EQ(si(text, Dimension::length), 2e-6) << text;
}

TEST(Units, SaysWhatIsWrong) {
  EXPECT_EQ(problem("5", Dimension::force), "\"5\" has no unit: a force is given in N, kN, MN");
  EXPECT_EQ(problem("5 kg", Dimension::time),
            "\"kg\" is not a unit of time: a time is given in s, ms, us, min, h");
  EXPECT_EQ(problem("5 kn", Dimension::force),
            "\"kn\" is not a unit of force: a force is given in N, kN, MN");
  EXPECT_EQ(problem("2 m", Dimension::angle),
            "\"m\" is not a unit of angle: an angle is given in rad, deg, mrad");
  EXPECT_EQ(problem("5 m", Dimension::none), "\"5 m\" is not a plain number: no unit but % is allowed");
  EXPECT_EQ(problem("1,5 kN", Dimension::force), "\"1,5 kN\" has a comma: write the decimal point as \".\"");
  EXPECT_EQ(problem("1e999 N", Dimension::force), "\"1e999 N\" is too large or too small a number");
  EXPECT_EQ(problem("1e308 GPa", Dimension::stress), "\"1e308 GPa\" is too large a number");
  for (const char* text : {"", " ", "N", "nan N", "inf N", "-inf N", "+-3 N", "five N", ".N", "0x"})
    EXPECT_NE(problem(text, Dimension::force), "no problem") << text;
  EXPECT_EQ(problem("nan", Dimension::none), "\"nan\" does not start with a number");
}

TEST(Units, LocaleDoesNotMatter) {
  const std::string before = std::setlocale(LC_ALL, nullptr);
  std::setlocale(LC_ALL, "de_DE.UTF-8");
  EXPECT_EQ(si("1.5 m", Dimension::length), 1.5);
  EXPECT_EQ(to_text(1.5, Dimension::length), "1.5 m");
  std::setlocale(LC_ALL, before.c_str());
}

TEST(Units, ShortestText) {
  EXPECT_EQ(to_text(0.3, Dimension::length), "0.3 m");
  EXPECT_EQ(to_text(20e3, Dimension::force), "20000 N");
  EXPECT_EQ(to_text(0.1 + 0.2, Dimension::none), "0.30000000000000004");
}

RC_GTEST_PROP(Units, EveryNumberReadsBackFromItsText, (double value, unsigned dimension)) {
  RC_PRE(std::isfinite(value));
  const auto d = static_cast<Dimension>(dimension % (static_cast<unsigned>(last_dimension) + 1));
  const auto back = parse_quantity(to_text(value, d), d);
  RC_ASSERT(std::holds_alternative<double>(back));
  RC_ASSERT(std::get<double>(back) == value);
}

RC_GTEST_PROP(Units, AnyTextIsReadOrRefused, (const std::string& text)) {
  for (unsigned i = 0; i <= static_cast<unsigned>(last_dimension); ++i) {
    const auto parsed = parse_quantity(text, static_cast<Dimension>(i));
    if (const double* value = std::get_if<double>(&parsed))
      RC_ASSERT(std::isfinite(*value));
    else
      RC_ASSERT(!std::get<std::string>(parsed).empty());
  }
}

}  // namespace
}  // namespace trackbed
