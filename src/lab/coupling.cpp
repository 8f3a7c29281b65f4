#include "lab/coupling.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>

#include "base/error.h"
#include "io/csv.h"
#include "io/files.h"
#include "lab/track/sleeper_peaks.h"
#include "lab/track/track_run.h"

namespace trackbed {
namespace {

namespace fs = std::filesystem;

CaseInput read_bed(const CoupledBedInput& in, double force) {
  std::vector<std::string> set = in.set;
  for (const std::string& key : in.force) set.push_back(fmt::format("{}=\"{} N\"", key, force * in.share));
  CaseInput bed;
  Document(in.file, set).read(bed);
  return bed;
}

Document bed_document(const CoupledBedInput& in) {
  return Document(in.file, in.set);
}

/// The bed of a case: built once, pressed anew each time.
class Bed {
 public:
  Bed(const CoupledBedInput& in, const CaseInput& bed, const RunOptions& options)
      : in_(in), options_(options), sim_(prepare_run(bed_document(in), bed)) {
    std::vector<NamedStage> stages = stages_of(bed);
    first_ = first_pressing(stages);
    stages.erase(stages.begin() + static_cast<std::ptrdiff_t>(first_), stages.end());
    if (!stages.empty()) carry(sim_, stages, bed, options_.out / "bed", options_);
  }

  PressHistory press(double force, const fs::path& out) const {
    const CaseInput bed = read_bed(in_, force);
    std::vector<NamedStage> stages = stages_of(bed);
    stages.erase(stages.begin(), stages.begin() + static_cast<std::ptrdiff_t>(first_));
    Simulation sim = sim_;
    RunOptions options = options_;
    options.keep.clear();  // the whole series is read: nothing is taken over from another run
    carry(sim, stages, bed, out, options);
    const PressHistory history = of_whole_sleeper(read_series(out / "series.csv"), in_.share, in_.below);
    check_curve(history, force * in_.share, out);
    return history;
  }

 private:
  std::size_t first_pressing(const std::vector<NamedStage>& stages) const {
    return static_cast<std::size_t>(std::ranges::find_if(stages,
                                                         [&](const NamedStage& s) {
                                                           return std::ranges::find(in_.stages, s.name) !=
                                                                  in_.stages.end();
                                                         }) -
                                    stages.begin());
  }

  static void carry(Simulation& sim, std::vector<NamedStage>& stages, const CaseInput& bed,
                    const fs::path& out, RunOptions options) {
    options.out = out;
    run_recorded(sim, stages, bed, options);
  }

  /// Refuses a bed that the track could not take as a support, where it still can be said why.
  static void check_curve(const PressHistory& history, double force, const fs::path& out) {
    try {
      support_curve(history);
    } catch (const InputError& error) {
      throw RunError(
          fmt::format("{}: pressed with {:.4g} N, recorded {} times: {}; press more slowly, or record more "
                      "often (record.every)",
                      out.string(), force, history.force.size(), error.what()));
    }
  }

  PressHistory read_series(const fs::path& series) const {
    const CsvTable table(series);
    const std::vector<std::string> stage = table.texts("stage");
    const std::vector<double> height = table.numbers(in_.body + ".displacement_z", Dimension::length),
                              force = table.numbers(in_.body + ".force_z", Dimension::force);
    PressHistory history;
    for (std::size_t k = 0; k < stage.size(); ++k) {
      if (std::ranges::find(in_.stages, stage[k]) == in_.stages.end()) continue;
      history.sinking.push_back(-height[k]);
      history.force.push_back(force[k]);
    }
    return history;
  }

  CoupledBedInput in_;
  RunOptions options_;
  Simulation sim_;
  std::size_t first_ = 0;  // of the stages that press
};

void check_bed(const Document& document, const CoupledBedInput& in, const CaseInput& bed) {
  if (!bed.bodies.contains(in.body))
    document.fail("bed.body", fmt::format("the case of the bed has no body called {}", in.body),
                  "name the body that is pressed");
  std::size_t first = bed.stages.size();
  for (const std::string& name : in.stages) {
    const auto found = std::ranges::find_if(bed.stages, [&](const auto& s) { return s.input->name == name; });
    if (found == bed.stages.end())
      document.fail("bed.stages", fmt::format("the case of the bed has no stage called {}", name),
                    "name the stages that press the sleeper");
    first = std::min(first, static_cast<std::size_t>(found - bed.stages.begin()));
  }
  for (const std::string& key : in.force) {
    const bool is_of_pressing = std::ranges::any_of(
        bed.stages.begin() + static_cast<std::ptrdiff_t>(first), bed.stages.end(),
        [&](const auto& stage) { return key.starts_with("stages." + stage.input->name + "."); });
    if (!is_of_pressing)
      document.fail("bed.force",
                    fmt::format("{} is no key of a stage from {} on", key, bed.stages[first].input->name),
                    "the bed is built once, and only what follows is done again; write stages.NAME.KEY");
  }
  try {
    read_bed(in, 1e4);
  } catch (const InputError& error) {
    document.fail("bed.force", error.what(), "name keys that take a force");
  }
}

void check_sleepers(const Document& document, const CouplingInput& in, const TrackLayoutInput& track) {
  std::set<int> taken;
  for (const OwnSupportInput& support : track.supports)
    for (const int number : numbers_of(support)) taken.insert(number);
  for (std::size_t k = 0; k < in.sleepers.size(); ++k)
    for (const int number : numbers_of(in.sleepers[k])) {
      const std::string here = fmt::format("sleepers.{}", k);
      if (support_of_sleeper(track, number) < 0)
        document.fail(here, fmt::format("there is no sleeper {} on an embankment", number),
                      "sleepers are counted from the bridge: -1, -2 before it, 1, 2 behind it");
      if (!taken.insert(number).second)
        document.fail(here, fmt::format("sleeper {} has two supports of its own", number),
                      "let the ranges not overlap, nor those of the track case");
    }
  if (in.sleepers.empty())
    document.fail("title", "no sleepers lie on the bed", "add a table [[sleepers]] with from and to");
}

std::vector<Column> round_columns() {
  using enum Dimension;
  return {{"round"},
          {"from"},
          {"to"},
          {"load", force},
          {"sinking", length},
          {"secant_stiffness", stiffness},
          {"unloading", stiffness},
          {"settlement", length},
          {"peak_force", force},
          {"change"}};
}

}  // namespace

void declare(Fields& f, PassageInput& in) {
  f.path(required("case"), in.file, "track case");
  f.texts("set", in.set, "changes in it, KEY=VALUE as for --set");
}

void declare(Fields& f, CoupledBedInput& in) {
  f.path(required("case"), in.file, "case of a bed with a sleeper");
  f.texts("set", in.set, "changes in it, KEY=VALUE as for --set");
  f.texts(required("force"), in.force,
          "keys of it that are given the largest force of the sleepers: stages.press.force");
  f.texts(
      required("stages"), in.stages,
      "its stages that press the sleeper and let it go; those before the first of them build the bed, once");
  f.text("body", in.body, "body that is pressed");
  f.number("share", in.share, {.above = 0, .at_most = 1},
           "of a whole sleeper that the bed bears: 0.25 for a section of a quarter of its length");
  f.number(
      "reach", in.reach, {.at_least = 1, .at_most = 3},
      "the bed is pressed with so many times the largest force: its curve then goes on beyond it, for a bed "
      "whose curve does not depend on how far it is pressed");
  f.quantity("below", in.below, Dimension::stiffness, {.above = 0},
             "stiffness under a whole sleeper of what lies below the bed; by default it does not give");
  f.check(!in.force.empty(), "force", "no key is given the force", "name one: stages.press.force");
  f.check(!in.stages.empty(), "stages", "no stage presses the sleeper", "name one");
}

void declare(Fields& f, CouplingInput& in) {
  f.text(required("title"), in.title, "what is coupled");
  f.section(required("passage"), in.passage, "the train and the track");
  f.section(required("bed"), in.bed, "the bed of stones");
  f.sequence(required("sleepers"), in.sleepers, "sleepers that lie on beds of stones; a bed for each range");
  f.number("tolerance", in.tolerance, {.above = 0, .below = 1},
           "the end is reached when no sleeper's peak force changes by more, over the largest of its range");
  f.integer("rounds", in.rounds, {.at_least = 1, .at_most = 100},
            "at most; a coupling that needs more fails");
}

namespace {

/// The force to press a bed with, so that the passage over it gives that force.
class Load {
 public:
  explicit Load(double first) : load_(first) {}
  double value() const { return load_; }
  /// The passage gave this one: it is next, or, between two that bracket the answer, where the chord is zero.
  void found(double peak) {
    const double excess = peak - load_, last = load_;
    if (last_excess_ * excess < 0)
      load_ -= excess * (load_ - last_) / (excess - last_excess_);
    else
      load_ = peak;
    last_ = last;
    last_excess_ = excess;
  }

 private:
  double load_, last_ = 0, last_excess_ = 0;  // [N]
};

/// Largest difference of two passages' peaks over the largest of the second.
double change_of(const std::vector<double>& before, const std::vector<double>& now) {
  double most = 0;
  for (std::size_t k = 0; k < now.size(); ++k) most = std::max(most, std::abs(now[k] - before[k]));
  return most / std::ranges::max(now);
}

/// Why the sleepers of a range press on nothing.
std::string nothing_presses(const std::vector<CouplingRound>& all, std::size_t range) {
  const auto last = std::find_if(all.rbegin(), all.rend(), [&](const auto& r) { return r.range == range; });
  if (last == all.rend()) return "the sleepers do not press on the ground: there is nothing to couple";
  return fmt::format(
      "round {}: sleepers hang above a bed that has settled by {:.3g} mm under {:.4g} kN; the rails bear the "
      "train, and there is nothing to couple",
      last->round, 1e3 * last->curve.settlement, 1e-3 * last->load);
}

}  // namespace

std::vector<CouplingRound> couple(double tolerance, int rounds, double reach, const Passage& passage,
                                  const Press& press, const std::function<void(const CouplingRound&)>& told) {
  std::vector<CouplingRound> all;
  std::vector<std::vector<double>> peaks = passage({}, 0);
  std::vector<Load> loads;
  for (const auto& range : peaks) loads.emplace_back(std::ranges::max(range));
  double worst = 0;
  for (int round = 1; round <= rounds; ++round) {
    std::vector<PressHistory> beds;
    for (std::size_t range = 0; range < peaks.size(); ++range) {
      if (!(loads[range].value() > 0)) throw RunError(nothing_presses(all, range));
      beds.push_back(press(range, reach * loads[range].value(), round));
    }
    const std::vector<std::vector<double>> next = passage(beds, round);
    worst = 0;
    for (std::size_t range = 0; range < peaks.size(); ++range) {
      const double load = loads[range].value(), peak = std::ranges::max(next[range]);
      const double change = peak > 0
                                ? std::max(change_of(peaks[range], next[range]), std::abs(load / peak - 1))
                                : std::numeric_limits<double>::infinity();  // sleepers hang: nothing agrees
      all.push_back({round, range, reach * load, support_curve(beds[range]), peak, change});
      if (told) told(all.back());
      loads[range].found(peak);
      worst = std::max(worst, change);
    }
    if (worst <= tolerance) return all;
    peaks = next;
  }
  throw RunError(fmt::format("after {} rounds sleepers' forces still change by {:.2g}, more than {:g}",
                             rounds, worst, tolerance));
}

CoupledCases check_coupling(const Document& document, const CouplingInput& in) {
  CoupledCases cases{Document(in.passage.file, in.passage.set), {}, {}};
  if (!is_track_case(cases.track_document))
    document.fail("passage.case", "this is no track case: it has no table [track]", "name a track case");
  cases.track_document.read(cases.track);
  check_track(cases.track_document, cases.track);
  check_sleepers(document, in, cases.track.track);
  bed_document(in.bed).read(cases.bed);
  check_bed(document, in.bed, cases.bed);
  return cases;
}

std::vector<CouplingRound> run_coupling(const Document& document, const CouplingInput& in,
                                        const RunOptions& options,
                                        const std::function<void(const CouplingRound&)>& told) {
  const CoupledCases cases = check_coupling(document, in);
  make_folder(options.out);
  const Bed bed(in.bed, cases.bed, options);

  const auto place = [&](const char* what, int round, std::size_t range) {
    return options.out / fmt::format("{}-{}-{}", what, round, range);
  };
  const Passage passage = [&](const std::vector<PressHistory>& beds, int round) {
    TrackCaseInput now = cases.track;
    for (std::size_t range = 0; range < beds.size(); ++range) {
      const fs::path file = place("curve", round, range).string() + ".csv";
      write_history(beds[range], file);
      now.track.supports.push_back({in.sleepers[range], fs::absolute(file), 0});
    }
    RunOptions there = options;
    there.out = options.out / fmt::format("passage-{}", round);
    run_track(cases.track_document, now, there);
    std::vector<std::vector<double>> peaks;
    for (const SleeperRange& range : in.sleepers) {
      const std::vector<int> numbers = numbers_of(range);
      peaks.emplace_back();
      for (const SleeperPeak& peak : read_peaks(there.out, {numbers.begin(), numbers.end()}))
        peaks.back().push_back(peak.force);
    }
    return peaks;
  };
  CsvWriter table(options.out / "rounds.csv", round_columns());
  return couple(
      in.tolerance, in.rounds, in.bed.reach, passage,
      [&](std::size_t range, double force, int round) {
        return bed.press(force, place("bed", round, range));
      },
      [&](const CouplingRound& r) {
        const SleeperRange& range = in.sleepers[r.range];
        table.add_row({double(r.round), double(range.from), double(range.to), r.load, r.curve.sinking.back(),
                       r.curve.secant(), r.curve.unloading, r.curve.settlement, r.peak, r.change});
        if (told) told(r);
      });
}

}  // namespace trackbed
