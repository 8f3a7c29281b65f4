// trackbed apss: shapes only where they matter. The bed of balls is tested first; where it is stirred most,
// the test that follows has clumps.
#include <fmt/format.h>

#include <algorithm>

#include "base/error.h"
#include "command_line.h"
#include "commands.h"
#include "io/progress.h"
#include "lab/influence.h"
#include "lab/recorder.h"
#include "lab/run.h"

namespace trackbed {
namespace {

namespace fs = std::filesystem;

struct ApssOptions {
  fs::path file, out;
  std::vector<std::string> overrides;
  std::string stage, by = "displacement";
  double share = 0.2;
  bool prepare_only = false;
  RunOptions run;
};

CaseInput read_case(const Document& document) {
  CaseInput experiment;
  document.read(experiment);
  return experiment;
}

bool replaces(const OneOf<StageInput>& stage) {
  return stage.kind == "replace";
}

/// The stage whose effect decides: that asked for, or the last.
std::string deciding_stage(const Document& document, const CaseInput& experiment, const std::string& asked) {
  if (std::ranges::none_of(experiment.stages, replaces))
    document.fail("stages", "no stage replaces balls by clumps",
                  "fill the bed with a set of balls and add a stage of kind replace");
  if (asked.empty()) return experiment.stages.back().input->name;
  if (std::ranges::none_of(experiment.stages, [&](const auto& s) { return s.input->name == asked; }))
    throw InputError(fmt::format("--stage {}: the case has no stage of that name", asked));
  return asked;
}

/// Runs the case without its replacements, unless its results are there already; returns its stones.csv.
fs::path run_balls(const ApssOptions& o, const Document& document, const std::string& stage) {
  RunOptions options = o.run;
  options.out = o.out / "balls";
  const fs::path stones = options.out / "stages" / (file_name_of(stage) + "-stones.csv");
  if (fs::exists(options.out / "summary.json") && fs::exists(stones)) {
    fmt::print("the bed of balls is taken from {}\n", options.out.string());
    return stones;
  }
  CaseInput experiment = read_case(document);
  std::erase_if(experiment.stages, replaces);
  experiment.record.tables = true;
  const Summary summary = run(document, experiment, options);
  fmt::print("bed of balls: {}\n", duration_text(summary.wall));
  return stones;
}

/// The case in which each stage that replaces does so in the influential area.
std::vector<std::string> overrides_of(const CaseInput& experiment, const fs::path& field, double threshold) {
  std::vector<std::string> all{fmt::format(R"(regions.apss={{kind = "field", file = "{}", above = {:.17g}}})",
                                           fs::absolute(field).string(), threshold)};
  for (const auto& stage : experiment.stages)
    if (replaces(stage)) all.push_back(fmt::format("stages.{}.region=apss", stage.input->name));
  return all;
}

}  // namespace

int apss_command(int argc, char** argv) {
  ApssOptions o;
  CLI::App app(
      "Adapts the shapes of stones to where they matter (APSS): runs the case with balls, finds where a "
      "stage "
      "stirs the bed most, and runs the case with clumps there and balls elsewhere.",
      "trackbed apss");
  app.add_option("case", o.file, "the case file (TOML); a stage of kind replace puts clumps for balls")
      ->required();
  app.add_option("--share", o.share, "share of the stones that become clumps")->check(CLI::Range(0.0, 1.0));
  app.add_option("--stage", o.stage, "stage whose effect decides; by default the last");
  app.add_option("--by", o.by, "what decides: displacement, or mean_stress")
      ->check(CLI::IsMember({"displacement", "mean_stress"}));
  app.add_option("--out", o.out, "folder of the results; default: out/NAME-apss of the case's folder");
  app.add_option("--set", o.overrides, "change a value of the case")
      ->type_name("KEY=VALUE")
      ->allow_extra_args(false);
  app.add_flag("--prepare-only", o.prepare_only, "stop when the area is found");
  app.add_option("--threads", o.run.threads, "number of threads; 0: one for each core")
      ->check(CLI::Range(0, 4096));
  app.add_flag("--quiet", o.run.quiet, "print nothing but errors");
  if (const auto code = parse(app, argc, argv)) return *code;
  if (o.out.empty())
    o.out = fs::path("out") / (fs::absolute(o.file).parent_path().filename().string() + "-apss");
  o.run.progress = stderr;

  const Document document(o.file, o.overrides);
  const CaseInput experiment = read_case(document);
  const std::string stage = deciding_stage(document, experiment, o.stage);
  const InfluenceField field = read_influence(run_balls(o, document, stage), o.by);
  const double threshold = threshold_for(field, o.share);
  write_influence(field, o.out / "influence.csv");
  std::vector<std::string> overrides = o.overrides;
  for (std::string& more : overrides_of(experiment, o.out / "influence.csv", threshold))
    overrides.push_back(std::move(more));
  fmt::print("influential area: {} above {:.4g} {} in stage {}\n", o.by, threshold,
             si_unit_of(field.dimension), stage);
  fmt::print("its case:\n  trackbed run {}", o.file.string());
  for (const std::string& value : overrides) fmt::print(" \\\n    --set '{}'", value);
  fmt::print("\n");
  if (o.prepare_only) return 0;

  const Document adapted(o.file, overrides);
  RunOptions options = o.run;
  options.out = o.out / "adapted";
  const Summary summary = run(adapted, read_case(adapted), options);
  fmt::print("adapted bed: {}\n", duration_text(summary.wall));
  for (const Result& r : summary.measures)
    if (r.name == "stones" || r.name == "pebbles" || r.name == "contacts" || r.name.ends_with(".replaced") ||
        r.name.ends_with(".share") || r.name.starts_with(stage + "."))
      fmt::print("  {:28} {:>12.6g} {}\n", r.name, r.value, si_unit_of(r.dimension));
  fmt::print("results: {}\n", options.out.string());
  return 0;
}

}  // namespace trackbed
