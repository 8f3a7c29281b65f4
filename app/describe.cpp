// trackbed describe: what may stand in a case, from the declarations that read it.
#include "io/describe.h"

#include <fmt/format.h>
#include <memory>

#include "command_line.h"
#include "commands.h"
#include "dem/laws/table.h"
#include "lab/case.h"
#include "lab/coupling.h"
#include "lab/measure.h"
#include "lab/study/study.h"
#include "lab/track/track_case.h"

namespace trackbed {
namespace {

/// The general measures, and those of a wall called WALL and a body called BODY.
std::vector<Measure> all_measures() {
  Simulation sim;
  sim.container.extend(Vec3::Zero()).extend(Vec3::Ones());
  sim.force_limits = RecordInput{}.force_bins;
  Wall wall{make_plane_wall("WALL", 1.0), 0, {}}, body = wall;
  body.shape.name = "BODY";
  body.body.emplace();
  add_wall(sim, wall, {});
  add_wall(sim, body, {});
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

}  // namespace

int describe_command(int argc, char** argv) {
  std::string name;
  bool markdown = false;
  CLI::App app("Says what may stand in a case: keys, stages, walls, bodies, measures, laws.",
               "trackbed describe");
  app.add_option("name", name, "a stage, wall or body, a table such as numerics, measures, or laws");
  app.add_flag("--markdown", markdown, "everything, as docs/input.md");
  if (const auto code = parse(app, argc, argv)) return *code;

  const auto defaults = std::make_unique<CaseInput>();
  const Description description = describe_with("case", "A case is one experiment: one TOML file.",
                                                [&](Fields& f) { declare(f, *defaults); });
  StudyInput study_defaults;
  const Description study =
      describe_with("study", "A study runs a case under many conditions: one TOML file.",
                    [&](Fields& f) { declare(f, study_defaults); });
  TrackCaseInput track_defaults;
  const Description track = describe_with(
      "track", "A track case is a train on a railway track: one TOML file with a table [track].",
      [&](Fields& f) { declare(f, track_defaults); });
  CouplingInput coupling_defaults;
  const Description coupling = describe_with(
      "coupling", "A coupling joins a track case and a bed: one TOML file for `trackbed couple`.",
      [&](Fields& f) { declare(f, coupling_defaults); });
  if (markdown)
    fmt::print("{}{}\n{}\n{}\n{}", to_markdown(description), measures_as_markdown(), to_markdown(track),
               to_markdown(study), to_markdown(coupling));
  else if (name.empty())
    fmt::print(
        "{}\nalso: trackbed describe measures, trackbed describe laws, trackbed describe study, trackbed "
        "describe track, trackbed describe coupling\n",
        to_text(description));
  else if (name == "measures")
    fmt::print("{}", measures_as_text());
  else if (name == "track")
    fmt::print("{}", to_text(track));
  else if (name == "coupling")
    fmt::print("{}", to_text(coupling));
  else if (name == "study")
    fmt::print("{}", to_text(study));
  else if (name == "laws")
    fmt::print("{}", laws_as_text());
  else
    fmt::print("{}", to_text(description.find(name)));
  return 0;
}

}  // namespace trackbed
