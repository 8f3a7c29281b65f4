#include "lab/study/study.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <set>

#include "base/error.h"
#include "base/hash.h"
#include "io/echo.h"
#include "lab/case.h"
#include "lab/checks.h"
#include "lab/track/track_case.h"

namespace trackbed {

void declare(Fields& f, ConditionInput& in) {
  f.text(required("name"), in.name, "name of the condition in the tables");
  f.texts("set", in.set, "changes of the case, KEY=VALUE as for --set");
}

void declare(Fields& f, SweepInput& in) {
  f.text(required("key"), in.key, "key of the case: stones.ratio, stages.load.force_max");
  f.texts(required("values"), in.values, "its values, each as text");
  f.text("along", in.along, "key of another sweep with as many values: both change together");
  f.check(!in.values.empty(), "values", "there is no value", "list at least one");
}

void declare(Fields& f, FitInput& in) {
  f.text(required("name"), in.name, "what the line is called in fits.csv");
  f.text(required("x"), in.x, "key of the case that conditions differ in: stages.press.force_max");
  f.text(required("y"), in.y, "measure, as in measures: shear.force_peak");
  f.quantity("area", in.area, Dimension::area, {.above = 0},
             "forces are divided by it, so that the line is one of stresses");
}

void declare(Fields& f, StudyInput& in) {
  f.text(required("title"), in.title, "what the study is about");
  f.path(required("case"), in.base, "the case file that all members start from");
  f.texts("set", in.set, "changes of the case in all members, KEY=VALUE as for --set");
  f.integer("repeats", in.repeats, {.at_least = 1, .at_most = 100000},
            "seeds of each condition; a track case, in which nothing is drawn by chance, has one");
  f.integer("first_seed", in.first_seed, {}, "seeds are counted up from here");
  f.texts(
      "measures", in.measures,
      "measures that the tables hold, at the end of the run or, STAGE.MEASURE, of a stage; by default all "
      "results of stages");
  f.sequence("conditions", in.conditions,
             "conditions that are written out; by default one, the case as it stands");
  f.sequence("sweep", in.sweeps,
             "keys that go through lists of values, crossed with each other and the conditions");
  f.sequence("fits", in.fits,
             "straight lines through the members of all conditions that differ in x alone, for fits.csv");
}

namespace {

/// "stones.ratio=0.3" in its two parts.
std::pair<std::string, std::string> parts_of(const std::string& change) {
  const std::size_t equals = change.find('=');
  if (equals == std::string::npos) return {change, ""};
  return {change.substr(0, equals), change.substr(equals + 1)};
}

void check_sweeps(const Document& document, const StudyInput& study) {
  for (std::size_t k = 0; k < study.sweeps.size(); ++k) {
    const SweepInput& sweep = study.sweeps[k];
    const std::string here = fmt::format("sweep.{}", k);
    if (sweep.along.empty()) continue;
    const auto leader = std::ranges::find(study.sweeps, sweep.along, &SweepInput::key);
    if (leader == study.sweeps.end() || !leader->along.empty() || sweep.along == sweep.key)
      document.fail(here + ".along", fmt::format("there is no sweep of {} to go along with", sweep.along),
                    "name the key of a sweep that goes by itself");
    if (leader->values.size() != sweep.values.size())
      document.fail(here + ".values",
                    fmt::format("{} values go along with {} of {}", sweep.values.size(),
                                leader->values.size(), sweep.along),
                    "give as many of each");
  }
}

void check_fits(const Document& document, const StudyInput& study, const std::vector<Condition>& conditions) {
  for (std::size_t k = 0; k < study.fits.size(); ++k)
    if (std::ranges::none_of(conditions,
                             [&](const Condition& c) { return c.inputs.contains(study.fits[k].x); }))
      document.fail(fmt::format("fits.{}.x", k), fmt::format("no condition changes {}", study.fits[k].x),
                    "name a key of a sweep or of conditions");
}

/// The condition with one more key.
Condition with(Condition condition, const std::string& key, const std::string& value) {
  condition.inputs[key] = value;
  condition.set.push_back(key + "=" + value);
  return condition;
}

/// Letters, digits, point, dash and underscore, so that it can be a part of a file name.
std::string plain(const std::string& text) {
  std::string out;
  for (char c : text) {
    const bool keeps = std::isalnum(static_cast<unsigned char>(c)) || c == '.' || c == '-';
    if (keeps || (!out.empty() && out.back() != '_')) out += keeps ? c : '_';
  }
  while (!out.empty() && out.back() == '_') out.pop_back();
  return out;
}

}  // namespace

std::vector<Condition> conditions_of(const Document& document, const StudyInput& study) {
  check_sweeps(document, study);
  std::vector<Condition> all;
  for (const ConditionInput& in : study.conditions) {
    Condition condition{in.name, {}, in.set};
    for (const std::string& change : in.set) condition.inputs.insert(parts_of(change));
    all.push_back(std::move(condition));
  }
  if (all.empty()) all.emplace_back();
  for (const SweepInput& sweep : study.sweeps) {
    if (!sweep.along.empty()) continue;
    std::vector<Condition> crossed;
    for (const Condition& condition : all)
      for (std::size_t v = 0; v < sweep.values.size(); ++v) {
        Condition next = with(condition, sweep.key, sweep.values[v]);
        const std::string last = sweep.key.substr(sweep.key.rfind('.') + 1);
        next.name += fmt::format("{}{} {}", next.name.empty() ? "" : ", ", last, sweep.values[v]);
        for (const SweepInput& follower : study.sweeps)
          if (follower.along == sweep.key) next = with(std::move(next), follower.key, follower.values[v]);
        crossed.push_back(std::move(next));
      }
    all = std::move(crossed);
  }
  if (all.size() == 1 && all[0].name.empty()) all[0].name = "case";
  std::set<std::string> names;
  for (const Condition& condition : all)
    if (!names.insert(plain(condition.name)).second)
      document.fail("conditions", fmt::format("two conditions are called {}", condition.name),
                    "give each a name of its own");
  check_fits(document, study, all);
  return all;
}

std::vector<std::string> changes_of(const StudyInput& study, const Condition& condition) {
  std::vector<std::string> all = study.set;
  all.insert(all.end(), condition.set.begin(), condition.set.end());
  return all;
}

/// What a case understands of its file and changes.
template <class Input>
nlohmann::ordered_json input_of(const std::filesystem::path& file, const std::vector<std::string>& set) {
  Input input;
  Document(file, set).read(input);
  return echo(input);
}

bool has_chance(const StudyInput& study) {
  return !is_track_case(Document(study.base));
}

Member make_member(const StudyInput& study, const std::vector<Condition>& conditions, std::size_t condition,
                   std::uint64_t seed) {
  Member member;
  member.condition = condition;
  member.seed = seed;
  member.name = fmt::format("{}-seed-{}", plain(conditions[condition].name), seed);
  member.set = changes_of(study, conditions[condition]);
  try {
    if (!has_chance(study)) {
      member.input = input_of<TrackCaseInput>(study.base, member.set);
      return member;
    }
    member.set.push_back(fmt::format("seed={}", seed));
    member.input = input_of<CaseInput>(study.base, member.set);
  } catch (const InputError& error) {
    throw InputError(fmt::format("the condition {}: {}", conditions[condition].name, error.what()));
  }
  return member;
}

std::string fingerprint(const Member& member) {
  Hash hash;
  hash.add(member.input.dump());
  return fmt::format("{:016x}", hash.value());
}

std::vector<Member> members_of(const StudyInput& study, const std::vector<Condition>& conditions) {
  std::vector<Member> members;
  const int repeats = has_chance(study) ? study.repeats : 1;
  for (int k = 0; k < repeats; ++k)
    for (std::size_t c = 0; c < conditions.size(); ++c)
      members.push_back(make_member(study, conditions, c, study.first_seed + static_cast<std::uint64_t>(k)));
  return members;
}

}  // namespace trackbed
