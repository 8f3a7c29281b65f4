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
  std::string stage, region, by = "displacement";
  double share = 0.2;
  bool prepare_only = false, reference = false;
  RunOptions run;
};

CaseInput read_case(const Document& document) {
  CaseInput experiment;
  document.read(experiment);
  return experiment;
}

/// The stage whose effect decides: that asked for, or the last.
std::string deciding_stage(const CaseInput& experiment, const std::string& asked) {
  if (asked.empty()) return experiment.stages.back().input->name;
  if (std::ranges::none_of(experiment.stages, [&](const auto& s) { return s.input->name == asked; }))
    throw InputError(fmt::format("--stage {}: the case has no stage of that name", asked));
  return asked;
}

/// The region that is to be found: that asked for, or the only one.
std::string region_to_find(const Document& document, const CaseInput& experiment, const std::string& asked) {
  if (!asked.empty()) {
    if (experiment.regions.contains(asked)) return asked;
    throw InputError(fmt::format("--region {}: the case has no region of that name", asked));
  }
  if (experiment.regions.size() == 1) return experiment.regions.begin()->first;
  document.fail("regions", "which of the regions is the one where stones have their shapes?",
                "name it with --region; the stages that place or replace stones name it too");
}

/// What a run prints last about the work it took.
struct Work {
  double stones = 0, pebbles = 0, contacts = 0, seconds = 0;
};

Work work_of(const Summary& summary) {
  const auto value = [&](std::string_view name) {
    const auto found = std::ranges::find(summary.measures, name, &Result::name);
    return found == summary.measures.end() ? 0.0 : found->value;
  };
  return {value("stones"), value("pebbles"), value("contacts"), summary.wall};
}

/// The case with another region in the place of the one that is to be found.
std::vector<std::string> with_region(const ApssOptions& o, const std::string& name,
                                     const std::string& table) {
  std::vector<std::string> overrides = o.overrides;
  overrides.push_back(fmt::format("regions.{}={}", name, table));
  return overrides;
}

Summary run_in(const ApssOptions& o, const std::string& folder, const std::vector<std::string>& overrides) {
  const Document document(o.file, overrides);
  CaseInput experiment = read_case(document);
  experiment.record.tables = true;  // the field is read from them
  RunOptions options = o.run;
  options.out = o.out / folder;
  return run(document, experiment, options);
}

/// Runs the case with balls alone, unless its results are there already; returns its stones.csv.
fs::path run_balls(const ApssOptions& o, const std::string& region, const std::string& stage) {
  const fs::path out = o.out / "balls";
  const fs::path stones = out / "stages" / (file_name_of(stage) + "-stones.csv");
  if (fs::exists(out / "summary.json") && fs::exists(stones)) {
    fmt::print("the bed of balls is taken from {}\n", out.string());
    return stones;
  }
  const Summary summary = run_in(o, "balls", with_region(o, region, R"({kind = "box", above = "1000 km"})"));
  fmt::print("bed of balls: {}\n", duration_text(summary.wall));
  return stones;
}

/// Pebbles of a bed all of whose stones have shapes, as many as those have that were replaced.
double pebbles_of_all(const Summary& adapted, const Work& work) {
  double replaced = 0;
  for (const Result& r : adapted.measures)
    if (r.name.ends_with(".replaced")) replaced += r.value;
  return replaced > 0 ? work.stones * (work.pebbles - (work.stones - replaced)) / replaced : work.pebbles;
}

void print_results(const ApssOptions& o, const std::string& stage, const Summary& adapted) {
  const Work work = work_of(adapted);
  fmt::print("adapted bed: {}, {:.0f} stones, {:.0f} pebbles, {:.0f} contacts\n", duration_text(work.seconds),
             work.stones, work.pebbles, work.contacts);
  fmt::print("  {:.0f} % fewer pebbles than with shapes everywhere\n",
             100 * (1 - work.pebbles / pebbles_of_all(adapted, work)));
  if (o.reference) {
    const Summary full = run_in(o, "reference", o.overrides);
    const Work all = work_of(full);
    fmt::print("reference:   {}, {:.0f} stones, {:.0f} pebbles, {:.0f} contacts\n",
               duration_text(all.seconds), all.stones, all.pebbles, all.contacts);
    fmt::print("saved: {:.0f} % of the time, {:.0f} % of the pebbles, {:.0f} % of the contacts\n",
               100 * (1 - work.seconds / all.seconds), 100 * (1 - work.pebbles / all.pebbles),
               100 * (1 - work.contacts / all.contacts));
  }
  for (const Result& r : adapted.measures)
    if (r.name.ends_with(".replaced") || r.name.ends_with(".share") || r.name.starts_with(stage + "."))
      fmt::print("  {:28} {:>12.6g} {}\n", r.name, r.value, si_unit_of(r.dimension));
}

}  // namespace

int apss_command(int argc, char** argv) {
  ApssOptions o;
  CLI::App app(
      "Adapts the shapes of stones to where they matter (APSS): runs the case with balls, finds where it "
      "moves the bed most, and runs the case with clumps there and balls elsewhere.",
      "trackbed apss");
  app.add_option("case", o.file, "the case file (TOML), with a region where stones have their shapes")
      ->required();
  app.add_option("--share", o.share, "share of the stones that become clumps")->check(CLI::Range(0.0, 1.0));
  app.add_option("--stage", o.stage, "stage whose effect decides; by default the last");
  app.add_option("--region", o.region, "region of the case that is found; by default its only one");
  app.add_option("--by", o.by, "what decides: displacement, or mean_stress")
      ->check(CLI::IsMember({"displacement", "mean_stress"}));
  app.add_option("--out", o.out, "folder of the results; default: out/NAME-apss of the case's folder");
  app.add_option("--set", o.overrides, "change a value of the case")
      ->type_name("KEY=VALUE")
      ->allow_extra_args(false);
  app.add_flag("--reference", o.reference,
               "also run the case as it stands, and tell what was saved against it");
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
  const std::string stage = deciding_stage(experiment, o.stage);
  const std::string region = region_to_find(document, experiment, o.region);
  const InfluenceField field = read_influence(run_balls(o, region, stage), o.by);
  const double threshold = threshold_for(field, o.share);
  write_influence(field, o.out / "influence.csv");
  const std::vector<std::string> overrides =
      with_region(o, region,
                  fmt::format(R"({{kind = "field", file = "{}", above = {:.17g}}})",
                              fs::absolute(o.out / "influence.csv").string(), threshold));
  fmt::print("influential area: {} above {:.4g} {} in the stage {}\n", o.by, threshold,
             si_unit_of(field.dimension), stage);
  fmt::print("its case:\n  trackbed run {}", o.file.string());
  for (const std::string& value : overrides) fmt::print(" \\\n    --set '{}'", value);
  fmt::print("\n");
  if (o.prepare_only) return 0;
  print_results(o, stage, run_in(o, "adapted", overrides));
  fmt::print("results: {}\n", o.out.string());
  return 0;
}

}  // namespace trackbed
