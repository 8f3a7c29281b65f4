// Which measures the runs of a study will leave, known before the first has run.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "lab/case.h"
#include "lab/study/study.h"

namespace trackbed {

/// Names of the measures that runs will leave, at their ends and at those of their stages.
class ForeseenMeasures {
 public:
  /// Of one run. Throws InputError when a wall cannot be built.
  explicit ForeseenMeasures(const CaseInput& run);
  /// Of all runs of a study. Those of tracks are not foreseen: there every name passes. Throws InputError
  /// when a case cannot be read.
  ForeseenMeasures(const StudyInput& study, const std::vector<Condition>& conditions);

  /// What the user may have meant by a name; nothing when some run leaves it.
  std::optional<std::string> hint_for(const std::string& name) const;

 private:
  std::vector<std::string> names_;  // NUMBER in one stands for a number
  bool all_pass_ = false;
};

/// Refuses, at its key, a measure of the study's tables and fits that no run will leave.
void check_measures(const Document& document, const StudyInput& study, const ForeseenMeasures& foreseen);

}  // namespace trackbed
