// Track and bed, each the other's boundary: the passage of a train says how hard sleepers press, a bed of
// stones that is pressed so says how it gives way, and the train passes again over sleepers on such beds,
// until the forces stay.
#pragma once

#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "lab/run.h"
#include "lab/track/support_curve.h"
#include "lab/track/track_case.h"

namespace trackbed {

struct PassageInput {
  std::filesystem::path file;    // a track case
  std::vector<std::string> set;  // changes, KEY=VALUE
};

struct CoupledBedInput {
  std::filesystem::path file;       // a case
  std::vector<std::string> set;     // changes, KEY=VALUE
  std::vector<std::string> force;   // its keys that are given the force
  std::vector<std::string> stages;  // that press the sleeper, the last of the case
  std::string body = "sleeper";
  double share = 1;             // of a whole sleeper that the bed bears
  double reach = 1;             // load over the largest force
  std::optional<double> below;  // [N/m]
};

struct CouplingInput {
  std::string title;
  PassageInput passage;
  CoupledBedInput bed;
  std::vector<SleeperRange> sleepers;
  double tolerance = 0.01;
  int rounds = 8;
};

void declare(Fields& f, CouplingInput& in);

/// What a coupling joins.
struct CoupledCases {
  Document track_document;
  TrackCaseInput track;
  CaseInput bed;
};

/// Reads both cases. Throws InputError at the key of the coupling, or of one of the cases, that is wrong.
CoupledCases check_coupling(const Document& document, const CouplingInput& in);

/// One bed in one round.
struct CouplingRound {
  int round = 1;
  std::size_t range = 0;  // of sleepers
  double load = 0;        // on a whole sleeper [N]
  SupportCurve curve;     // that came of it
  double peak = 0;        // largest force of the range in the passage that followed [N]
  // Largest change of a sleeper's peak from the passage before, over that force, or of the load to it.
  double change = 0;
};

/// Peak forces of the sleepers of each range when they lie on beds that were pressed so; on the track case's
/// own ground where there are no histories [N].
using Passage =
    std::function<std::vector<std::vector<double>>(const std::vector<PressHistory>& beds, int round)>;
/// What the bed of a range does under a force on a whole sleeper [N].
using Press = std::function<PressHistory(std::size_t range, double force, int round)>;

/// Presses each bed with `reach` times the largest force of its range and lets the train pass again, until no
/// force changes by more than the tolerance. Throws RunError when `rounds` are not enough. `told` is called
/// after each round.
std::vector<CouplingRound> couple(double tolerance, int rounds, double reach, const Passage& passage,
                                  const Press& press,
                                  const std::function<void(const CouplingRound&)>& told = {});

/// Does it with the cases of `in`. Leaves in options.out: passage-N, bed-N-RANGE, the results of the cases by
/// rounds (passage-0: on the track case's own ground); bed, where it is built; curve-N-RANGE.csv, what the
/// track case reads; rounds.csv. Throws InputError, RunError.
std::vector<CouplingRound> run_coupling(const Document& document, const CouplingInput& in,
                                        const RunOptions& options,
                                        const std::function<void(const CouplingRound&)>& told = {});

}  // namespace trackbed
