#include "expected.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <stdexcept>

#include "lab/study/foreseen.h"
#include "lab/track/track_run.h"

namespace trackbed {

void declare(Fields& f, ExpectedMeasure& in) {
  f.text(required("name"), in.name, "as in summary.json");
  f.number(required("value"), in.value, {}, "in SI");
  f.number(required("tolerance"), in.tolerance, {.at_least = 0}, "largest deviation, in SI");
  f.text(required("reason"), in.reason, "why this tolerance");
}

void declare(Fields& f, Expected& in) {
  f.texts("set", in.set, "changes that make the case short");
  f.sequence(required("measures"), in.measures, "what must come out");
}

double value_of(const std::vector<Result>& results, const std::string& name) {
  const auto found = std::ranges::find(results, name, &Result::name);
  return found == results.end() ? std::numeric_limits<double>::quiet_NaN() : found->value;
}

const StageSummary& stage_of(const Summary& summary, const std::string& name) {
  const auto found = std::ranges::find(summary.stages, name, &StageSummary::name);
  if (found == summary.stages.end()) throw std::runtime_error("there is no stage " + name);
  return *found;
}

void expect_foreseen(const CaseInput& experiment, const Summary& summary) {
  const ForeseenMeasures foreseen(experiment);
  for (const Result& r : summary.measures) EXPECT_FALSE(foreseen.hint_for(r.name)) << r.name;
}

namespace {

Summary run_one(const Document& document, const RunOptions& options) {
  if (is_track_case(document)) {
    TrackCaseInput in;
    document.read(in);
    return run_track(document, in, options);
  }
  CaseInput experiment;
  document.read(experiment);
  Summary summary = run(document, experiment, options);
  expect_foreseen(experiment, summary);
  return summary;
}

}  // namespace

Summary run_short_form(const std::string& name, const std::filesystem::path& out,
                       const std::vector<std::string>& changes) {
  const std::filesystem::path folder = std::filesystem::path(TRACKBED_ROOT) / "cases" / name;
  std::vector<std::string> set = read_input<Expected>(folder / "expected.toml").set;
  set.insert(set.end(), changes.begin(), changes.end());
  return run_one(Document(folder / "case.toml", set), {.out = out, .threads = 1, .quiet = true});
}

Summary run_and_compare(const std::string& name, const std::filesystem::path& out) {
  const auto expected =
      read_input<Expected>(std::filesystem::path(TRACKBED_ROOT) / "cases" / name / "expected.toml");
  const Summary summary = run_short_form(name, out, {});
  for (const ExpectedMeasure& m : expected.measures)
    EXPECT_NEAR(value_of(summary.measures, m.name), m.value, m.tolerance) << m.name << ": " << m.reason;
  return summary;
}

}  // namespace trackbed
