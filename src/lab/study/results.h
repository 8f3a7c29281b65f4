// What a study has so far: the state of each member, and the two tables made of their summaries.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "lab/study/statistics.h"
#include "lab/study/study.h"

namespace trackbed {

enum class MemberStatus { waiting, done, failed };

/// A member and what became of it.
struct Outcome {
  MemberStatus status = MemberStatus::waiting;
  std::string cause;               // of a failure, or why old results are not good any more
  nlohmann::ordered_json summary;  // of a member that is done
};

/// Looks into the member's folder: results count when they are of the same input. A failure counts as well
/// (failure.json), so that it is not tried again and again.
Outcome outcome_of(const Member& member, const std::filesystem::path& folder);

/// Remembers that a member failed, with its input.
void write_failure(const Member& member, const std::string& cause, const std::filesystem::path& folder);

/// Value of a measure of a summary, at the end of the run or, as "STAGE.MEASURE", at the end of a stage;
/// nothing when it has none.
std::optional<double> measure_in(const nlohmann::ordered_json& summary, const std::string& name);

/// Value and unit of such a measure.
struct MeasureValue {
  double value = 0;
  std::string unit;
};
std::optional<MeasureValue> find_in(const nlohmann::ordered_json& summary, const std::string& name);

/// study.csv: a row a member with every changed key, seed, status, measures with units, seconds and state
/// hash. Throws InputError for a measure that no finished member has.
void write_members(const StudyInput& study, const std::vector<Condition>& conditions,
                   const std::vector<Member>& members, const std::vector<Outcome>& outcomes,
                   const std::filesystem::path& path);

/// table.csv: a row for each condition and measure with number of repeats, mean, standard deviation and 95 %
/// interval.
void write_table(const StudyInput& study, const std::vector<Condition>& conditions,
                 const std::vector<Member>& members, const std::vector<Outcome>& outcomes,
                 const std::filesystem::path& path);

/// A measure over the finished members of a condition.
Estimate estimate_of(const std::string& measure, std::size_t condition, const std::vector<Member>& members,
                     const std::vector<Outcome>& outcomes);

}  // namespace trackbed
