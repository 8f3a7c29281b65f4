// What a short form of a case must give: cases/NAME/expected.toml.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "lab/run.h"

namespace trackbed {

struct ExpectedMeasure {
  std::string name;  // in summary.json
  double value = 0;  // SI
  double tolerance = 0;
  std::string reason;  // why this tolerance
};

struct Expected {
  std::vector<std::string> set;  // changes that make the case short, as for --set
  std::vector<ExpectedMeasure> measures;
};

void declare(Fields& f, Expected& in);

/// Runs the short form of cases/NAME into the folder, with further changes.
Summary run_short_form(const std::string& name, const std::filesystem::path& out,
                       const std::vector<std::string>& changes);

/// Runs the short form of cases/NAME into the folder and compares every measure.
Summary run_and_compare(const std::string& name, const std::filesystem::path& out);

/// That every measure which a run has left was foreseen from its case.
void expect_foreseen(const CaseInput& experiment, const Summary& summary);

/// Of a measure at the end of a stage, or the result of a stage; NaN when there is none.
double value_of(const std::vector<Result>& results, const std::string& name);
const StageSummary& stage_of(const Summary& summary, const std::string& name);

}  // namespace trackbed
