#include "lab/study/results.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "base/error.h"
#include "io/csv.h"
#include "io/echo.h"
#include "io/files.h"
#include "io/nearest.h"

namespace trackbed {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

constexpr const char* failure_file = "failure.json";

/// A JSON file; nothing when there is none or it is broken.
std::optional<Json> read_json(const fs::path& path) {
  if (!fs::exists(path)) return std::nullopt;
  Json json = Json::parse(read_file(path), nullptr, false);
  if (json.is_discarded()) return std::nullopt;
  return json;
}

const char* text_of(MemberStatus status) {
  switch (status) {
    case MemberStatus::done:
      return "done";
    case MemberStatus::failed:
      return "failed";
    case MemberStatus::waiting:
      break;
  }
  return "waiting";
}

/// The keys that some condition changes.
std::vector<std::string> changed_keys(const std::vector<Condition>& conditions) {
  std::set<std::string> keys;
  for (const Condition& condition : conditions)
    for (const auto& [key, value] : condition.inputs) keys.insert(key);
  return {keys.begin(), keys.end()};
}

std::string input_at(const Condition& condition, const std::string& key) {
  const auto found = condition.inputs.find(key);
  return found == condition.inputs.end() ? "" : found->second;
}

/// Value and unit of a measure at the end of the run or, "STAGE.MEASURE", of a stage; null when there is
/// none.
const Json* find_measure(const Json& summary, const std::string& name) {
  if (!summary.is_object()) return nullptr;
  if (summary["measures"].contains(name)) return &summary["measures"][name];
  const std::size_t point = name.find('.');
  if (point == std::string::npos) return nullptr;
  for (const Json& stage : summary["stages"])
    if (stage["name"] == name.substr(0, point) && stage.contains("measures") &&
        stage["measures"].contains(name.substr(point + 1)))
      return &stage["measures"][name.substr(point + 1)];
  return nullptr;
}

/// The measures of the tables: those of the study, or all results of stages, in the order of the first
/// summary.
std::vector<std::string> measures_of(const StudyInput& study, const std::vector<Outcome>& outcomes) {
  std::vector<std::string> all;
  std::set<std::string> of_stages;
  for (const Outcome& outcome : outcomes) {
    if (outcome.status != MemberStatus::done) continue;
    for (const Json& stage : outcome.summary["stages"])
      for (const auto& [name, result] : stage["results"].items())
        of_stages.insert(stage["name"].get<std::string>() + "." + name);
    for (const auto& [name, value] : outcome.summary["measures"].items())
      if (std::ranges::find(all, name) == all.end()) all.push_back(name);
  }
  if (study.measures.empty()) {
    std::erase_if(all, [&](const std::string& name) { return !of_stages.contains(name); });
    return all;
  }
  // As long as some are missing, so may be those of the only condition that leaves it.
  const auto is_done = [](const Outcome& o) { return o.status == MemberStatus::done; };
  if (!outcomes.empty() && std::ranges::all_of(outcomes, is_done))
    for (const std::string& name : study.measures)
      if (std::ranges::none_of(outcomes, [&](const Outcome& o) { return find_measure(o.summary, name); }))
        throw InputError(fmt::format("no member has the measure {}: {}", name, known_words(name, all)));
  return study.measures;
}

std::string unit_of(const std::string& measure, const std::vector<Outcome>& outcomes) {
  for (const Outcome& outcome : outcomes)
    if (const auto found = find_in(outcome.summary, measure)) return found->unit;
  return "-";
}

}  // namespace

Outcome outcome_of(const Member& member, const fs::path& folder) {
  if (const auto summary = read_json(folder / "summary.json"); summary && summary->contains("input")) {
    if ((*summary)["input"] == member.input) return {MemberStatus::done, "", *summary};
    return {MemberStatus::waiting, difference((*summary)["input"], member.input), {}};
  }
  if (const auto failure = read_json(folder / failure_file); failure && failure->contains("input")) {
    if ((*failure)["input"] == member.input)
      return {MemberStatus::failed, (*failure)["cause"].get<std::string>(), {}};
    return {MemberStatus::waiting, difference((*failure)["input"], member.input), {}};
  }
  return {};
}

void write_failure(const Member& member, const std::string& cause, const fs::path& folder) {
  make_folder(folder);
  write_file(folder / failure_file, Json{{"cause", cause}, {"input", member.input}}.dump(1));
}

std::optional<MeasureValue> find_in(const Json& summary, const std::string& name) {
  const Json* found = find_measure(summary, name);
  if (!found || !(*found)["value"].is_number()) return std::nullopt;
  return MeasureValue{(*found)["value"].get<double>(), (*found)["unit"].get<std::string>()};
}

std::optional<double> measure_in(const Json& summary, const std::string& name) {
  const auto found = find_in(summary, name);
  return found ? std::optional(found->value) : std::nullopt;
}

void write_members(const StudyInput& study, const std::vector<Condition>& conditions,
                   const std::vector<Member>& members, const std::vector<Outcome>& outcomes,
                   const fs::path& path) {
  const std::vector<std::string> keys = changed_keys(conditions), measures = measures_of(study, outcomes);
  CsvRows rows;
  std::vector<std::string> header{"member", "condition"};
  header.insert(header.end(), keys.begin(), keys.end());
  header.insert(header.end(), {"seed", "status", "cause"});
  for (const std::string& name : measures)
    header.push_back(fmt::format("{} [{}]", name, unit_of(name, outcomes)));
  header.insert(header.end(), {"wall time [s]", "state hash"});
  rows.add(header);
  for (std::size_t m = 0; m < members.size(); ++m) {
    const Condition& condition = conditions[members[m].condition];
    const Outcome& outcome = outcomes[m];
    const bool done = outcome.status == MemberStatus::done;
    std::vector<std::string> row{members[m].name, condition.name};
    for (const std::string& key : keys) row.push_back(input_at(condition, key));
    row.insert(row.end(), {std::to_string(members[m].seed), text_of(outcome.status),
                           outcome.status == MemberStatus::failed ? outcome.cause : ""});
    for (const std::string& name : measures)
      row.push_back(csv_number(measure_in(outcome.summary, name).value_or(NAN)));
    row.push_back(done ? csv_number(outcome.summary["wall_s"].get<double>()) : "");
    row.push_back(done ? outcome.summary["state_hash"].get<std::string>() : "");
    rows.add(row);
  }
  rows.write(path);
}

Estimate estimate_of(const std::string& measure, std::size_t condition, const std::vector<Member>& members,
                     const std::vector<Outcome>& outcomes) {
  std::vector<double> values;
  for (std::size_t m = 0; m < members.size(); ++m)
    if (members[m].condition == condition && outcomes[m].status == MemberStatus::done)
      values.push_back(measure_in(outcomes[m].summary, measure).value_or(NAN));
  return estimate(values);
}

void write_table(const StudyInput& study, const std::vector<Condition>& conditions,
                 const std::vector<Member>& members, const std::vector<Outcome>& outcomes,
                 const fs::path& path) {
  const std::vector<std::string> keys = changed_keys(conditions), measures = measures_of(study, outcomes);
  CsvRows rows;
  std::vector<std::string> header{"condition"};
  header.insert(header.end(), keys.begin(), keys.end());
  header.insert(header.end(),
                {"measure", "unit", "n", "mean", "standard deviation", "95 % low", "95 % high"});
  rows.add(header);
  for (std::size_t c = 0; c < conditions.size(); ++c)
    for (const std::string& name : measures) {
      const Estimate e = estimate_of(name, c, members, outcomes);
      std::vector<std::string> row{conditions[c].name};
      for (const std::string& key : keys) row.push_back(input_at(conditions[c], key));
      row.insert(row.end(), {name, unit_of(name, outcomes), std::to_string(e.n), csv_number(e.mean),
                             csv_number(e.deviation), csv_number(e.low()), csv_number(e.high())});
      rows.add(row);
    }
  rows.write(path);
}

}  // namespace trackbed
