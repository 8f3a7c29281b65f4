#include "lab/study/judge.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <string_view>
#include <utility>

#include "base/error.h"
#include "io/csv.h"
#include "io/files.h"
#include "lab/recorder.h"
#include "lab/study/results.h"

namespace trackbed {
namespace {

/// Normals of contacts that push a body up point upwards by more than this: not those of steep sides.
constexpr double least_rise = 0.17;  // sine of 10 degrees

/// A step of a cumulative distribution.
struct Rise {
  double place = 0, share = 0;
};

void add_rises(const Bearing& bearing, double weight, std::vector<Rise>& rises) {
  for (std::size_t k = 0; k < bearing.place.size(); ++k)
    rises.push_back({bearing.place[k], weight * bearing.share[k]});
}

/// Mean of a number over the references.
template <class Get>
double mean_of(const std::vector<Bearing>& references, Get&& get) {
  double sum = 0;
  for (const Bearing& r : references) sum += get(r);
  return sum / static_cast<double>(references.size());
}

}  // namespace

void declare(Fields& f, BearingInput& in) {
  f.text(required("stage"), in.stage, "stage at whose end the contacts are looked at");
  f.quantity(required("width"), in.width, Dimension::length, {.above = 0}, "of the body along x");
  f.quantity("middle", in.middle, Dimension::length, {}, "of the body along x");
}

void declare(Fields& f, JudgeInput& in) {
  f.text(required("title"), in.title, "what is judged");
  f.text("body", in.body, "body whose underside bears on the stones, in members and references");
  f.section(required("members"), in.members, "the runs that are judged");
  f.section(required("references"), in.references, "the runs that they are compared with");
  f.number(required("distance"), in.distance, {.at_least = 0, .at_most = 1},
           "largest area between the cumulative distributions of the vertical force, from the middle of the "
           "body (0) to its edge (1)");
  f.number(required("place"), in.place, {.at_least = 0, .at_most = 1},
           "largest distance between the places of the largest contact force, over half of the width");
  f.number(required("share"), in.share, {.at_least = 1},
           "largest contact force over all force: largest factor between the member and the references, up "
           "or down");
  f.texts("measures", in.measures, "measures that are given for accepted, refused and all members");
}

Bearing read_bearing(const std::filesystem::path& run, const std::string& body, const BearingInput& where) {
  const std::filesystem::path path = run / "stages" / (file_name_of(where.stage) + "-contacts.csv");
  const CsvTable table(path);
  const std::vector<std::string> wall = table.texts("wall");
  const std::vector<double> x = table.numbers("x", Dimension::length),
                            rise = table.numbers("normal_z", Dimension::none),
                            magnitude = table.numbers("force", Dimension::force),
                            vertical = table.numbers("force_z", Dimension::force);
  Bearing bearing;
  std::vector<std::pair<double, double>> all;
  for (std::size_t k = 0; k < wall.size(); ++k) {
    if (wall[k] != body || rise[k] < least_rise) continue;
    const double place = std::min(1.0, std::abs(x[k] - where.middle) / (0.5 * where.width));
    all.emplace_back(place, vertical[k]);
    bearing.force += vertical[k];
    if (magnitude[k] <= bearing.largest) continue;
    bearing.largest = magnitude[k];
    bearing.largest_place = place;
  }
  if (!(bearing.force > 0)) throw InputError(fmt::format("{}: no stone pushes {} up", path.string(), body));
  std::ranges::sort(all);
  for (const auto& [place, force] : all) {
    bearing.place.push_back(place);
    bearing.share.push_back(force / bearing.force);
  }
  return bearing;
}

Likeness compare(const Bearing& member, const std::vector<Bearing>& references) {
  std::vector<Rise> rises;
  add_rises(member, 1, rises);
  for (const Bearing& r : references) add_rises(r, -1.0 / static_cast<double>(references.size()), rises);
  std::ranges::stable_sort(rises, {}, &Rise::place);
  Likeness likeness;
  double between = 0;
  for (std::size_t k = 0; k < rises.size(); ++k) {
    between += rises[k].share;
    const double next = k + 1 < rises.size() ? rises[k + 1].place : 1.0;
    likeness.distance += std::abs(between) * (next - rises[k].place);
  }
  const auto share = [](const Bearing& b) { return b.largest / b.force; };
  likeness.place =
      std::abs(member.largest_place - mean_of(references, [](const Bearing& b) { return b.largest_place; }));
  likeness.share = share(member) / mean_of(references, share);
  return likeness;
}

std::string refusal(const Likeness& likeness, const JudgeInput& rule) {
  std::vector<std::string> reasons;
  if (likeness.distance > rule.distance)
    reasons.push_back(fmt::format("the force lies elsewhere: {:.3g} of half the width, {:.3g} is allowed",
                                  likeness.distance, rule.distance));
  if (likeness.place > rule.place)
    reasons.push_back(fmt::format("the largest force acts {:.3g} of half the width away, {:.3g} is allowed",
                                  likeness.place, rule.place));
  if (likeness.share > rule.share || likeness.share < 1 / rule.share)
    reasons.push_back(
        fmt::format("the largest force is {:.3g} times as much of all, a factor of {:.3g} is "
                    "allowed",
                    likeness.share, rule.share));
  return fmt::format("{}", fmt::join(reasons, "; "));
}

namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

/// Folders of the runs that ended: the folder itself, or the members of a study.
std::vector<fs::path> runs_in(const fs::path& folder) {
  if (fs::exists(folder / "summary.json")) return {folder};
  std::vector<fs::path> runs;
  if (fs::exists(folder / "members"))
    for (const fs::directory_entry& member : fs::directory_iterator(folder / "members"))
      if (fs::exists(member.path() / "summary.json")) runs.push_back(member.path());
  if (runs.empty())
    throw InputError(fmt::format("{}: holds no run that has ended: no summary.json", folder.string()));
  std::ranges::sort(runs);
  return runs;
}

std::vector<Judged> read_runs(const JudgeInput& rule, const std::vector<fs::path>& folders,
                              bool are_references) {
  std::vector<Judged> runs;
  for (const fs::path& folder : folders)
    for (const fs::path& run : runs_in(folder)) {
      Judged judged;
      judged.name = fs::weakly_canonical(run).filename().string();
      judged.group = judged.name.substr(0, judged.name.rfind("-seed-"));
      judged.is_reference = are_references;
      judged.bearing = read_bearing(run, rule.body, are_references ? rule.references : rule.members);
      judged.summary = Json::parse(read_file(run / "summary.json"));
      runs.push_back(std::move(judged));
    }
  return runs;
}

std::string unit_of(const std::string& measure, const std::vector<Judged>& runs) {
  for (const Judged& run : runs)
    if (const auto found = find_in(run.summary, measure)) return found->unit;
  return "-";
}

const char* verdict_of(const Judged& run) {
  if (run.is_reference) return "reference";
  return run.refusal.empty() ? "accepted" : "refused";
}

/// What the rows of judge-table.csv are about.
struct Part {
  std::string group;
  const char* verdict;  // null: all
};

void add_part(const JudgeInput& rule, const std::vector<Judged>& runs, const Part& part, CsvRows& rows) {
  for (const std::string& measure : rule.measures) {
    std::vector<double> values;
    for (const Judged& run : runs) {
      if (run.is_reference || run.group != part.group) continue;
      if (part.verdict && std::string_view(verdict_of(run)) != part.verdict) continue;
      if (const auto value = measure_in(run.summary, measure)) values.push_back(*value);
    }
    const Estimate e = estimate(values);
    rows.add({part.group, part.verdict ? part.verdict : "all", measure, unit_of(measure, runs),
              std::to_string(e.n), csv_number(e.mean), csv_number(e.deviation), csv_number(e.low()),
              csv_number(e.high())});
  }
}

}  // namespace

std::vector<Judged> judge(const JudgeInput& rule, const std::vector<fs::path>& members,
                          const std::vector<fs::path>& references) {
  std::vector<Judged> runs = read_runs(rule, members, false), others = read_runs(rule, references, true);
  std::vector<Bearing> bearings;
  for (const Judged& other : others) bearings.push_back(other.bearing);
  for (Judged& run : runs) {
    run.likeness = compare(run.bearing, bearings);
    run.refusal = refusal(run.likeness, rule);
  }
  for (std::size_t k = 0; k < others.size(); ++k) {
    others[k].likeness = {NAN, NAN, NAN};
    if (others.size() == 1) break;
    std::vector<Bearing> rest = bearings;
    rest.erase(rest.begin() + static_cast<std::ptrdiff_t>(k));
    others[k].likeness = compare(others[k].bearing, rest);
    others[k].refusal = refusal(others[k].likeness, rule);
  }
  std::ranges::move(others, std::back_inserter(runs));
  return runs;
}

void write_judgement(const JudgeInput& rule, const std::vector<Judged>& runs, const fs::path& folder) {
  CsvRows rows;
  std::vector<std::string> header{
      "run",       "group",     "verdict",           "reason",        "distance [-]", "place [-]",
      "share [-]", "force [N]", "largest force [N]", "largest at [-]"};
  for (const std::string& measure : rule.measures)
    header.push_back(fmt::format("{} [{}]", measure, unit_of(measure, runs)));
  rows.add(header);
  std::vector<std::string> groups;
  for (const Judged& run : runs) {
    std::vector<std::string> row{run.name, run.group, verdict_of(run), run.refusal};
    for (double v : {run.likeness.distance, run.likeness.place, run.likeness.share, run.bearing.force,
                     run.bearing.largest, run.bearing.largest_place})
      row.push_back(csv_number(v));
    for (const std::string& measure : rule.measures)
      row.push_back(csv_number(measure_in(run.summary, measure).value_or(NAN)));
    rows.add(row);
    if (!run.is_reference && std::ranges::find(groups, run.group) == groups.end())
      groups.push_back(run.group);
  }
  rows.write(folder / "judge.csv");
  CsvRows table;
  table.add(
      {"group", "members", "measure", "unit", "n", "mean", "standard deviation", "95 % low", "95 % high"});
  for (const std::string& group : groups)
    for (const char* verdict : {"accepted", "refused", static_cast<const char*>(nullptr)})
      add_part(rule, runs, {group, verdict}, table);
  table.write(folder / "judge-table.csv");
}

}  // namespace trackbed
