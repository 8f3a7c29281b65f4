#include "base/units.h"

#include <fmt/format.h>

#include <array>
#include <charconv>
#include <cmath>
#include <numbers>
#include <span>
#include <utility>

namespace trackbed {
namespace {

/// SI value = number * times / over. Both are exact where a decimal unit allows it, so that "300 mm" is the
/// double nearest to 0.3.
struct Unit {
  std::string_view name;
  double times = 1.0;
  double over = 1.0;
};

constexpr double pi = std::numbers::pi;

// The SI unit comes first.
constexpr std::array none_units = {Unit{"-"}, Unit{"%", 1, 100}};
constexpr std::array length_units = {Unit{"m"}, Unit{"mm", 1, 1e3}, Unit{"cm", 1, 1e2}, Unit{"um", 1, 1e6},
                                     Unit{"km", 1e3}};
constexpr std::array area_units = {Unit{"m^2"}, Unit{"mm^2", 1, 1e6}, Unit{"cm^2", 1, 1e4}};
constexpr std::array volume_units = {Unit{"m^3"}, Unit{"mm^3", 1, 1e9}, Unit{"cm^3", 1, 1e6},
                                     Unit{"L", 1, 1e3}};
constexpr std::array time_units = {Unit{"s"}, Unit{"ms", 1, 1e3}, Unit{"us", 1, 1e6}, Unit{"min", 60},
                                   Unit{"h", 3600}};
constexpr std::array frequency_units = {Unit{"Hz"}, Unit{"kHz", 1e3}, Unit{"1/s"}};
constexpr std::array velocity_units = {Unit{"m/s"}, Unit{"mm/s", 1, 1e3}, Unit{"km/h", 1, 3.6},
                                       Unit{"mm/min", 1, 60e3}};
constexpr std::array acceleration_units = {Unit{"m/s^2"}, Unit{"mm/s^2", 1, 1e3}, Unit{"g", 9.80665},
                                           Unit{"g0", 9.80665}};
constexpr std::array angle_units = {Unit{"rad"}, Unit{"deg", pi, 180}, Unit{"mrad", 1, 1e3}};
constexpr std::array angular_velocity_units = {Unit{"rad/s"}, Unit{"deg/s", pi, 180},
                                               Unit{"rpm", 2 * pi, 60}};
constexpr std::array mass_units = {Unit{"kg"}, Unit{"g", 1, 1e3}, Unit{"t", 1e3}};
constexpr std::array density_units = {Unit{"kg/m^3"}, Unit{"t/m^3", 1e3}, Unit{"g/cm^3", 1e3}};
constexpr std::array force_units = {Unit{"N"}, Unit{"kN", 1e3}, Unit{"MN", 1e6}};
constexpr std::array moment_units = {Unit{"N m"}, Unit{"kN m", 1e3}, Unit{"MN m", 1e6}, Unit{"N mm", 1, 1e3}};
constexpr std::array stress_units = {Unit{"Pa"}, Unit{"kPa", 1e3}, Unit{"MPa", 1e6}, Unit{"GPa", 1e9},
                                     Unit{"N/mm^2", 1e6}};
constexpr std::array stiffness_units = {Unit{"N/m"}, Unit{"kN/m", 1e3}, Unit{"MN/m", 1e6}, Unit{"kN/mm", 1e6},
                                        Unit{"N/mm", 1e3}};
constexpr std::array energy_units = {Unit{"J"}, Unit{"kJ", 1e3}, Unit{"mJ", 1, 1e3}};
constexpr std::array damping_units = {Unit{"N s/m"}, Unit{"kN s/m", 1e3}, Unit{"MN s/m", 1e6}};
constexpr std::array rotational_stiffness_units = {Unit{"N m/rad"}, Unit{"kN m/rad", 1e3},
                                                   Unit{"MN m/rad", 1e6}};
constexpr std::array second_moment_units = {Unit{"m^4"}, Unit{"cm^4", 1, 1e8}, Unit{"mm^4", 1, 1e12}};
constexpr std::array hertz_constant_units = {Unit{"N/m^1.5"}};

struct Table {
  std::string_view name;  // "length"
  std::span<const Unit> units;
};

// In the order of the enum.
constexpr std::array tables = {
    Table{"number", none_units},
    Table{"length", length_units},
    Table{"area", area_units},
    Table{"volume", volume_units},
    Table{"time", time_units},
    Table{"frequency", frequency_units},
    Table{"velocity", velocity_units},
    Table{"acceleration", acceleration_units},
    Table{"angle", angle_units},
    Table{"angular velocity", angular_velocity_units},
    Table{"mass", mass_units},
    Table{"density", density_units},
    Table{"force", force_units},
    Table{"moment", moment_units},
    Table{"stress", stress_units},
    Table{"stiffness", stiffness_units},
    Table{"energy", energy_units},
    Table{"damping", damping_units},
    Table{"rotational stiffness", rotational_stiffness_units},
    Table{"second moment of area", second_moment_units},
    Table{"Hertz constant", hertz_constant_units},
};
static_assert(tables.size() == static_cast<std::size_t>(Dimension::hertz_constant) + 1);

const Table& table_of(Dimension dimension) {
  return tables[static_cast<std::size_t>(dimension)];
}

std::string_view trimmed(std::string_view text) {
  constexpr std::string_view blanks = " \t";
  const std::size_t first = text.find_first_not_of(blanks);
  if (first == std::string_view::npos) return {};
  return text.substr(first, text.find_last_not_of(blanks) - first + 1);
}

/// One spelling for all: "kg/m³", "kg/m^3" and "kg/m3" are "kg/m3".
std::string plain_spelling(std::string_view unit) {
  constexpr std::array<std::pair<std::string_view, std::string_view>, 8> spellings = {{{"^", ""},
                                                                                       {"²", "2"},
                                                                                       {"³", "3"},
                                                                                       {"*", " "},
                                                                                       {"·", " "},
                                                                                       {"°", "deg"},
                                                                                       {"\u00b5", "u"},
                                                                                       {"\u03bc", "u"}}};
  std::string plain(unit);
  for (const auto& [from, to] : spellings)
    for (std::size_t at = plain.find(from); at != std::string::npos; at = plain.find(from, at + to.size()))
      plain.replace(at, from.size(), to);
  return plain;
}

/// "a time", "an angle"
std::string with_article(std::string_view noun) {
  const bool vowel = std::string_view("aeiou").find(noun.front()) != std::string_view::npos;
  return fmt::format("{} {}", vowel ? "an" : "a", noun);
}

}  // namespace

std::string_view name_of(Dimension dimension) {
  return table_of(dimension).name;
}

std::string_view si_unit_of(Dimension dimension) {
  return table_of(dimension).units.front().name;
}

std::string units_of(Dimension dimension) {
  std::string list;
  for (const Unit& unit : table_of(dimension).units) {
    if (unit.name == "-") continue;
    if (!list.empty()) list += ", ";
    list += unit.name;
  }
  return list;
}

std::variant<double, std::string> parse_quantity(std::string_view text, Dimension dimension) {
  const Table& table = table_of(dimension);
  const std::string_view all = trimmed(text);
  std::string_view digits = all;
  // std::from_chars takes no plus sign.
  if (digits.size() > 1 && digits[0] == '+' && digits[1] != '-') digits.remove_prefix(1);
  double number = 0.0;
  const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), number);
  if (error == std::errc::result_out_of_range)
    return fmt::format("\"{}\" is too large or too small a number", all);
  if (error != std::errc{} || !std::isfinite(number))
    return fmt::format("\"{}\" does not start with a number", all);

  const std::string_view unit = trimmed(digits.substr(static_cast<std::size_t>(end - digits.data())));
  if (unit.starts_with(",")) return fmt::format("\"{}\" has a comma: write the decimal point as \".\"", all);
  if (unit.empty()) {
    if (dimension == Dimension::none) return number;
    return fmt::format("\"{}\" has no unit: {} is given in {}", all, with_article(table.name),
                       units_of(dimension));
  }
  const std::string spelling = plain_spelling(unit);
  for (const Unit& known : table.units) {
    if (plain_spelling(known.name) != spelling) continue;
    const double value = number * known.times / known.over;
    if (!std::isfinite(value)) return fmt::format("\"{}\" is too large a number", all);
    return value;
  }
  if (dimension == Dimension::none)
    return fmt::format("\"{}\" is not a plain number: no unit but % is allowed", all);
  return fmt::format("\"{}\" is not a unit of {}: {} is given in {}", unit, table.name,
                     with_article(table.name), units_of(dimension));
}

std::string to_text(double value, Dimension dimension) {
  if (dimension == Dimension::none) return fmt::format("{}", value);
  return fmt::format("{} {}", value, si_unit_of(dimension));
}

}  // namespace trackbed
