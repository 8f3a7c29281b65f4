// Whether runs of one model are like those of another: how a body's underside bears on the stones, by a rule
// that is written down before.
#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "io/schema.h"

namespace trackbed {

/// Runs of one model: when and where their body bears.
struct BearingInput {
  std::string stage;  // at whose end contacts are looked at
  double width = 0;   // of the body along x [m]
  double middle = 0;  // of the body along x [m]
};

/// The rule: a member is accepted when all three numbers of Likeness are within these limits.
struct JudgeInput {
  std::string title;
  std::string body = "sleeper";
  BearingInput members, references;
  double distance = 0;                // largest [-]
  double place = 0;                   // largest [-]
  double share = 1;                   // largest factor, up or down [-]
  std::vector<std::string> measures;  // that are given for accepted, refused and all members
};

void declare(Fields& f, JudgeInput& in);

/// How a body's underside bears on stones: contacts that push it up, from the middle of the body outwards.
struct Bearing {
  std::vector<double> place;  // |x - middle| over half of the width, ascending [-]
  std::vector<double> share;  // of the vertical force, beside place [-]
  double force = 0;           // vertical, of all of them [N]
  double largest = 0;         // largest single contact force [N]
  double largest_place = 0;   // where that acts [-]
};

/// From stages/STAGE-contacts.csv of a run's folder. Throws InputError when that cannot be read, or nothing
/// pushes the body up.
Bearing read_bearing(const std::filesystem::path& run, const std::string& body, const BearingInput& where);

/// A member against the mean of the references.
struct Likeness {
  /// Area between the cumulative distributions of the force over place: the part of half the width by which
  /// the force would have to be moved on the mean to make one of the other (Wasserstein distance) [-].
  double distance = 0;
  double place = 0;  // between the places of the largest contact forces [-]
  double share = 0;  // largest contact force over all force, beside that of the references [-]
};

/// `references`: one at least.
Likeness compare(const Bearing& member, const std::vector<Bearing>& references);

/// Why the rule refuses it; empty when it is accepted.
std::string refusal(const Likeness& likeness, const JudgeInput& rule);

/// A run that was compared with the references; a reference is compared with the others, and one that is
/// alone with nothing: its likeness is not a number.
struct Judged {
  std::string name, group;  // "wedge-seed-3" is of the group "wedge"
  bool is_reference = false;
  Bearing bearing;
  Likeness likeness;
  std::string refusal;             // empty: accepted
  nlohmann::ordered_json summary;  // of the run
};

/// All runs in the folders, each a run's own or that of a study with its members. Throws InputError where
/// there are none that ended, or they bear on nothing.
std::vector<Judged> judge(const JudgeInput& rule, const std::vector<std::filesystem::path>& members,
                          const std::vector<std::filesystem::path>& references);

/// judge.csv: a row a run with its likeness, verdict, reason and the measures of the rule. judge-table.csv:
/// these measures of each group over accepted, refused and all members: number, mean, standard deviation and
/// 95 % interval.
void write_judgement(const JudgeInput& rule, const std::vector<Judged>& runs,
                     const std::filesystem::path& folder);

}  // namespace trackbed
