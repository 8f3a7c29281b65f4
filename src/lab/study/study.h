// A study: one case run under several conditions, each with several seeds. STUDY.toml says which.
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "io/read.h"
#include "io/schema.h"

namespace trackbed {

/// A condition that is written out.
struct ConditionInput {
  std::string name;
  std::vector<std::string> set;  // changes of the case, KEY=VALUE
};

/// A key that goes through several values. Sweeps are crossed with each other and with the conditions.
struct SweepInput {
  std::string key;
  std::vector<std::string> values;
  std::string along;  // key of another sweep that it goes along with instead
};

/// A straight line through a measure against a key of the case.
struct FitInput {
  std::string name;
  std::string x;               // key of the case, a quantity
  std::string y;               // measure
  std::optional<double> area;  // that forces are divided by [m^2]
};

struct StudyInput {
  std::string title;
  std::filesystem::path base;
  std::vector<std::string> set;  // of all members
  int repeats = 3;
  std::uint64_t first_seed = 1;
  std::vector<std::string> measures;  // of the tables; empty: all results of stages
  std::vector<ConditionInput> conditions;
  std::vector<SweepInput> sweeps;
  std::vector<FitInput> fits;
};

void declare(Fields& f, StudyInput& in);

/// What members that differ by their seed alone have in common.
struct Condition {
  std::string name;
  std::map<std::string, std::string> inputs;  // the keys that are changed, and to what
  std::vector<std::string> set;               // the same as the case wants them
};

/// All conditions in the order of the file: written ones, each crossed with all sweeps, the last sweep
/// fastest. Throws InputError at the key that is wrong.
std::vector<Condition> conditions_of(const Document& document, const StudyInput& study);

/// What all members of a condition change in the case: the study's changes, then the condition's.
std::vector<std::string> changes_of(const StudyInput& study, const Condition& condition);

/// One run.
struct Member {
  std::size_t condition = 0;  // in the list of conditions
  std::uint64_t seed = 1;
  std::string name;              // of its folder
  std::vector<std::string> set;  // changes of the case
  nlohmann::ordered_json input;  // the case as it was understood: what decides whether results are still good
};

/// Of the input: two members with the same one give the same results.
std::string fingerprint(const Member& member);

/// Whether seeds change anything: not in a track case.
bool has_chance(const StudyInput& study);

/// The members of all conditions with seeds first_seed to first_seed + repeats - 1, or one each where nothing
/// is drawn by chance. Every case is read and checked: throws InputError that names the member.
std::vector<Member> members_of(const StudyInput& study, const std::vector<Condition>& conditions);

/// The member of one more seed.
Member make_member(const StudyInput& study, const std::vector<Condition>& conditions, std::size_t condition,
                   std::uint64_t seed);

}  // namespace trackbed
