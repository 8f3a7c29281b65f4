// trackbed describe: what may stand in a case, from the declarations that read it.
#include "io/describe.h"

#include <fmt/format.h>

#include <algorithm>
#include <memory>
#include <vector>

#include "command_line.h"
#include "commands.h"
#include "dem/laws/table.h"
#include "lab/case.h"
#include "lab/coupling.h"
#include "lab/measure.h"
#include "lab/study/judge.h"
#include "lab/study/study.h"
#include "lab/track/track_case.h"

namespace trackbed {
namespace {

/// The general measures, and those of a wall called WALL and a body called BODY.
std::vector<Measure> all_measures() {
  Simulation sim;
  sim.container.extend(Vec3::Zero()).extend(Vec3::Ones());
  sim.force_limits = RecordInput{}.force_bins;
  add_wall(sim, {make_plane_wall("WALL", 1.0), 0, {}}, {});
  add_body_by_name(sim, "BODY");
  return measures_of(sim);
}

std::string measures_as_text() {
  std::string text = "measures: columns of series.csv (record.measures) and entries of summary.json\n";
  for (const Measure& m : all_measures())
    text += fmt::format("  {:28} [{}]  {}\n", m.name, si_unit_of(m.dimension), m.meaning);
  return text;
}

std::string laws_as_text() {
  std::string text = "laws: contact.law\n";
  for (const auto& [name, kind] : law_names) text += fmt::format("  {}\n", name);
  return text;
}

std::string measures_as_markdown() {
  std::string text =
      "\n## Every measure\n\nColumns of `series.csv` (`record.measures`) and entries of `summary.json`.\n\n"
      "| measure | unit | meaning |\n|---|---|---|\n";
  for (const Measure& m : all_measures())
    text += fmt::format("| `{}` | {} | {} |\n", m.name, si_unit_of(m.dimension), m.meaning);
  return text;
}

template <class Input>
Description describe_file(const char* name, const char* meaning) {
  const auto defaults = std::make_unique<Input>();
  return describe_with(name, meaning, [&](Fields& f) { declare(f, *defaults); });
}

}  // namespace

int describe_command(int argc, char** argv) {
  std::string name;
  bool markdown = false;
  CLI::App app("Says what may stand in a case: keys, stages, walls, bodies, measures, laws.",
               "trackbed describe");
  app.add_option("name", name, "a stage, wall or body, a table such as numerics, measures, or laws");
  app.add_flag("--markdown", markdown, "everything, as docs/input.md");
  if (const auto code = parse(app, argc, argv)) return *code;

  const Description experiment = describe_file<CaseInput>("case", "A case is one experiment: one TOML file.");
  const std::vector<Description> others{
      describe_file<TrackCaseInput>(
          "track", "A track case is a train on a railway track: one TOML file with a table [track]."),
      describe_file<StudyInput>("study", "A study runs a case under many conditions: one TOML file."),
      describe_file<JudgeInput>("judge",
                                "A rule by which `trackbed judge` accepts or refuses runs: one TOML file."),
      describe_file<CouplingInput>(
          "coupling", "A coupling joins a track case and a bed: one TOML file for `trackbed couple`.")};
  const auto other = std::ranges::find(others, name, [](const Description& d) { return d.top.name; });
  if (markdown) {
    fmt::print("{}{}", to_markdown(experiment), measures_as_markdown());
    for (const Description& d : others) fmt::print("\n{}", to_markdown(d));
  } else if (name.empty()) {
    fmt::print("{}\nalso: trackbed describe measures, trackbed describe laws", to_text(experiment));
    for (const Description& d : others) fmt::print(", trackbed describe {}", d.top.name);
    fmt::print("\n");
  } else if (other != others.end()) {
    fmt::print("{}", to_text(*other));
  } else if (name == "measures") {
    fmt::print("{}", measures_as_text());
  } else if (name == "laws") {
    fmt::print("{}", laws_as_text());
  } else {
    fmt::print("{}", to_text(experiment.find(name)));
  }
  return 0;
}

}  // namespace trackbed
