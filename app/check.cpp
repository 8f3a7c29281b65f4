// trackbed check: what a file would do, without doing it.
#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "command_line.h"
#include "commands.h"
#include "lab/coupling.h"
#include "lab/run.h"
#include "lab/study/foreseen.h"
#include "lab/study/judge.h"
#include "lab/study/study.h"
#include "lab/track/track_case.h"

namespace trackbed {
namespace {

void print_model(const CaseInput& experiment, const Simulation& sim) {
  fmt::print("{}\n", experiment.title);
  std::vector<std::size_t> pebbles;
  for (const ClumpTemplate& t : sim.model.templates) pebbles.push_back(t.pebbles.size());
  std::ranges::sort(pebbles);
  fmt::print("  stone shapes  {}, with {} to {} pebbles\n", pebbles.size(), pebbles.front(), pebbles.back());
  for (std::size_t w = 0; w < sim.model.walls.size(); ++w) {
    const Wall& wall = sim.model.walls[w];
    const std::string mass = wall.body ? fmt::format(", {:.4g} kg", wall.body->mass) : "";
    fmt::print("  {:12}  {} ({}{})\n", wall.body ? "body" : "wall", wall.shape.name,
               sim.model.materials[static_cast<std::size_t>(wall.material)].name, mass);
  }
  if (sim.container.isEmpty()) return;
  const Vec3 size = sim.container.sizes();
  fmt::print("  container     {:.4g} x {:.4g} x {:.4g} m\n", size.x(), size.y(), size.z());
}

void print_stages(const CaseInput& experiment) {
  const std::vector<NamedStage> stages = stages_of(experiment);
  for (std::size_t k = 0; k < stages.size(); ++k) {
    const std::string kind = stages[k].kind == stages[k].name ? "" : fmt::format(" ({})", stages[k].kind);
    fmt::print("  stage {:<2}      {}{}\n", k + 1, stages[k].name, kind);
  }
}

void check_case(const Document& document) {
  CaseInput experiment;
  document.read(experiment);
  print_model(experiment, prepare_run(document, experiment));
  print_stages(experiment);
}

void check_track_case(const Document& document) {
  TrackCaseInput in;
  document.read(in);
  check_track(document, in);
  const std::vector<int> n = sleepers_of(in.track);
  const Journey journey = journey_of(in);
  fmt::print("{}\n", in.title);
  fmt::print("  sleepers      {} before the bridge, {} behind\n", n[0] + n[1], n[3] + n[4]);
  fmt::print("  bridge        {} m, {} fastenings\n", in.track.bridge, n[2]);
  fmt::print("  train         {:.4g} t at {:.4g} km/h, first wheel from {:.4g} m to {:.4g} m\n",
             4e-3 * in.train.vehicle.axle_load, 3.6 * in.train.speed, journey.start, journey.end);
}

void check_study(const Document& document) {
  StudyInput study;
  document.read(study);
  const std::vector<Condition> conditions = conditions_of(document, study);
  const std::vector<Member> members = members_of(study, conditions);
  check_measures(document, study, {study, conditions});
  fmt::print("{}\n  case          {}\n", study.title, study.base.string());
  for (const Condition& condition : conditions) fmt::print("  condition     {}\n", condition.name);
  fmt::print("  runs          {}, of {} seeds from {}\n", members.size(), study.repeats, study.first_seed);
}

void check_rule(const Document& document) {
  JudgeInput rule;
  document.read(rule);
  fmt::print("{}\n  accepted      {} within {:g}, {:g} and a factor of {:g}\n", rule.title,
             "distance, place and share of the largest force", rule.distance, rule.place, rule.share);
  fmt::print("  members       at the end of {}\n  references    at the end of {}\n", rule.members.stage,
             rule.references.stage);
}

void check_joined(const Document& document) {
  CouplingInput in;
  document.read(in);
  const CoupledCases cases = check_coupling(document, in);
  fmt::print("{}\n  track         {}\n  bed           {}\n", in.title, cases.track.title, cases.bed.title);
  for (const SleeperRange& range : in.sleepers)
    fmt::print("  sleepers      {} to {} lie on it\n", range.from, range.to);
}

/// A kind of file, by a key that every one of its kind has and no other.
struct FileKind {
  std::string_view key;
  void (*check)(const Document&);
};

constexpr std::array kinds = {
    FileKind{"track", check_track_case},
    FileKind{"case", check_study},
    FileKind{"references", check_rule},
    FileKind{"passage", check_joined},
};

}  // namespace

int check_command(int argc, char** argv) {
  std::filesystem::path file;
  std::vector<std::string> overrides;
  CLI::App app("Checks a case, a study, a rule or a coupling and says what it would do; runs nothing.",
               "trackbed check");
  app.add_option("file", file, "the file (TOML)")->required();
  app.add_option("--set", overrides, "change a value of the file: stages.load.duration='2 s'")
      ->type_name("KEY=VALUE")
      ->allow_extra_args(false);
  if (const auto code = parse(app, argc, argv)) return *code;

  const Document document(file, overrides);
  const auto kind = std::ranges::find_if(kinds, [&](const FileKind& k) { return document.has(k.key); });
  (kind == kinds.end() ? check_case : kind->check)(document);
  fmt::print("nothing is wrong with {}\n", file.string());
  return 0;
}

}  // namespace trackbed
