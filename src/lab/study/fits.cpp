#include "lab/study/fits.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <limits>
#include <map>
#include <numbers>
#include <set>

#include "base/error.h"
#include "io/csv.h"

namespace trackbed {
namespace {

using Json = nlohmann::ordered_json;
using Inputs = std::map<std::string, std::string>;

struct Quantity {
  double value = 0;  // SI
  std::string unit;
};

bool has_name(const Json& element, const std::string& name) {
  return element.is_object() && element.value("name", "") == name;
}

/// The value at a dotted key of a resolved input; elements of lists are found by their names or numbers.
const Json* at(const Json& input, const std::string& key) {
  const Json* node = &input;
  for (std::size_t from = 0; from <= key.size();) {
    const std::size_t dot = std::min(key.find('.', from), key.size());
    const std::string part = key.substr(from, dot - from);
    from = dot + 1;
    const Json* next = nullptr;
    if (node->is_object() && node->contains(part)) next = &(*node)[part];
    for (std::size_t k = 0; node->is_array() && k < node->size(); ++k)
      if (part == std::to_string(k) || has_name((*node)[k], part)) next = &(*node)[k];
    if (!next) return nullptr;
    node = next;
  }
  return node;
}

/// A number, or a text such as "36000 N": resolved inputs are in SI.
Quantity quantity_at(const Member& member, const std::string& key) {
  const Json* found = at(member.input, key);
  if (found && found->is_number()) return {found->get<double>(), "-"};
  Quantity q;
  if (found && found->is_string()) {
    const std::string text = found->get<std::string>();
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), q.value);
    if (error == std::errc() && *end == ' ') {
      q.unit = end + 1;
      return q;
    }
  }
  throw InputError(fmt::format("fits: {} is no quantity of the case", key));
}

/// Points of one line, and what they have in common.
struct Group {
  Inputs inputs;
  std::vector<double> x, y;
  std::string x_unit = "-", y_unit = "-";
};

std::vector<Group> groups_of(const FitInput& fit, const std::vector<Condition>& conditions,
                             const std::vector<Member>& members, const std::vector<Outcome>& outcomes) {
  std::vector<Group> groups;
  for (std::size_t m = 0; m < members.size(); ++m) {
    Inputs inputs = conditions[members[m].condition].inputs;
    inputs.erase(fit.x);
    auto group = std::ranges::find(groups, inputs, &Group::inputs);
    if (group == groups.end()) group = groups.insert(group, {inputs, {}, {}});
    if (outcomes[m].status != MemberStatus::done) continue;
    const std::optional<MeasureValue> y = find_in(outcomes[m].summary, fit.y);
    if (!y) continue;
    const Quantity x = quantity_at(members[m], fit.x);
    group->x.push_back(x.value);
    group->y.push_back(y->value);
    group->x_unit = x.unit;
    group->y_unit = y->unit;
  }
  return groups;
}

void add_with_interval(std::vector<std::string>& row, double value, double half_width) {
  row.insert(row.end(), {csv_number(value), csv_number(value - half_width), csv_number(value + half_width)});
}

/// Forces become stresses.
void divide(std::vector<double>& values, std::string& unit, const std::optional<double>& area) {
  if (!area || unit != si_unit_of(Dimension::force)) return;
  for (double& value : values) value /= *area;
  unit = si_unit_of(Dimension::stress);
}

std::vector<std::string> row_of(const FitInput& fit, Group group, const std::set<std::string>& keys) {
  divide(group.x, group.x_unit, fit.area);
  divide(group.y, group.y_unit, fit.area);
  const LineFit line = fit_line(group.x, group.y);
  std::vector<std::string> row{fit.name};
  for (const std::string& key : keys) row.push_back(group.inputs.contains(key) ? group.inputs.at(key) : "");
  row.insert(row.end(), {std::to_string(line.n), group.y_unit});
  add_with_interval(row, line.intercept, line.intercept_half_width);
  row.push_back(group.y_unit == group.x_unit ? "-" : fmt::format("{} per {}", group.y_unit, group.x_unit));
  add_with_interval(row, line.slope, line.slope_half_width);
  for (const double slope :
       {line.slope, line.slope - line.slope_half_width, line.slope + line.slope_half_width})
    row.push_back(group.y_unit == group.x_unit ? csv_number(std::atan(slope) * 180 / std::numbers::pi) : "");
  row.push_back(csv_number(line.r_squared));
  return row;
}

}  // namespace

void write_fits(const StudyInput& study, const std::vector<Condition>& conditions,
                const std::vector<Member>& members, const std::vector<Outcome>& outcomes,
                const std::filesystem::path& path) {
  if (study.fits.empty()) return;
  std::set<std::string> keys;
  for (const Condition& condition : conditions)
    for (const auto& [key, value] : condition.inputs) keys.insert(key);
  std::erase_if(keys, [&](const std::string& key) {  // in which all that is on a line differs
    return std::ranges::all_of(study.fits, [&](const FitInput& fit) { return fit.x == key; });
  });
  std::vector<std::string> header{"fit"};
  header.insert(header.end(), keys.begin(), keys.end());
  header.insert(header.end(),
                {"n", "unit of y", "intercept", "95 % low", "95 % high", "unit of the slope", "slope",
                 "95 % low", "95 % high", "angle [deg]", "95 % low", "95 % high", "R^2"});
  CsvRows rows;
  rows.add(header);
  for (const FitInput& fit : study.fits)
    for (const Group& group : groups_of(fit, conditions, members, outcomes))
      rows.add(row_of(fit, group, keys));
  rows.write(path);
}

}  // namespace trackbed
