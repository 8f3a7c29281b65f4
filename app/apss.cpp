// trackbed apss: shapes only where they matter. The bed of balls is tested first; where it is stirred most,
// the test that follows has clumps.
#include <fmt/format.h>

#include <algorithm>

#include "base/error.h"
#include "command_line.h"
#include "commands.h"
#include "io/echo.h"
#include "io/progress.h"
#include "kept.h"
#include "lab/influence.h"
#include "lab/recorder.h"
#include "lab/run.h"
#include "lab/study/results.h"
#include "resumable.h"

namespace trackbed {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

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

Work work_of(const Json& summary) {
  const auto value = [&](const char* name) { return measure_in(summary, name).value_or(0.0); };
  return {value("stones"), value("pebbles"), value("contacts"), summary["wall_s"].get<double>()};
}

/// The case with another region in the place of the one that is to be found.
std::vector<std::string> with_region(const ApssOptions& o, const std::string& name,
                                     const std::string& table) {
  std::vector<std::string> overrides = o.overrides;
  overrides.push_back(fmt::format("regions.{}={}", name, table));
  return overrides;
}

/// Results of the case: those that its folder has, if `may_take`, or else those of a run.
Json results_in(const ApssOptions& o, const std::string& folder, const Document& document,
                const CaseInput& experiment, bool may_take) {
  RunOptions options = o.run;
  options.out = o.out / folder;
  if (may_take)
    if (const auto found = results_of(echo(experiment), options.out)) return *found;
  return to_json(run_until_signal(document, experiment, options));
}

Json results_in(const ApssOptions& o, const std::string& folder, const std::vector<std::string>& overrides) {
  const Document document(o.file, overrides);
  return results_in(o, folder, document, read_case(document), o.run.resume);
}

/// So that the stage's table of stones is written: from it the field is read.
void record_stones(const std::string& stage, CaseInput& experiment) {
  RecordInput& record = experiment.record;
  record.tables = true;
  record.stages.clear();
  const auto is_before = [&](const std::string& kept) {
    for (const auto& one : experiment.stages) {
      if (one.input->name == stage) return false;
      if (one.input->name == kept) return true;
    }
    return false;
  };
  std::erase_if(record.keep, [&](const std::string& kept) { return !is_before(kept); });
}

/// The case with balls alone; returns its stones.csv. Another share or another area does not change it.
fs::path run_balls(const ApssOptions& o, const std::string& region, const std::string& stage) {
  const Document document(o.file, with_region(o, region, R"({kind = "box", above = "1000 km"})"));
  CaseInput experiment = read_case(document);
  record_stones(stage, experiment);
  const Json summary = results_in(o, "balls", document, experiment, true);
  fmt::print("bed of balls: {}\n", duration_text(work_of(summary).seconds));
  return o.out / "balls" / "stages" / (file_name_of(stage) + "-stones.csv");
}

/// Pebbles of a bed all of whose stones have shapes, as many as those have that were replaced.
double pebbles_of_all(const Json& adapted, const Work& work) {
  double replaced = 0;
  for (const auto& [name, result] : adapted["measures"].items())
    if (name.ends_with(".replaced")) replaced += result["value"].get<double>();
  return replaced > 0 ? work.stones * (work.pebbles - (work.stones - replaced)) / replaced : work.pebbles;
}

void print_results(const ApssOptions& o, const std::string& stage, const Json& adapted) {
  const Work work = work_of(adapted);
  fmt::print("adapted bed: {}, {:.0f} stones, {:.0f} pebbles, {:.0f} contacts\n", duration_text(work.seconds),
             work.stones, work.pebbles, work.contacts);
  fmt::print("  {:.0f} % fewer pebbles than with shapes everywhere\n",
             100 * (1 - work.pebbles / pebbles_of_all(adapted, work)));
  if (o.reference) {
    const Work all = work_of(results_in(o, "reference", o.overrides));
    fmt::print("reference:   {}, {:.0f} stones, {:.0f} pebbles, {:.0f} contacts\n",
               duration_text(all.seconds), all.stones, all.pebbles, all.contacts);
    fmt::print("saved: {:.0f} % of the time, {:.0f} % of the pebbles, {:.0f} % of the contacts\n",
               100 * (1 - work.seconds / all.seconds), 100 * (1 - work.pebbles / all.pebbles),
               100 * (1 - work.contacts / all.contacts));
  }
  for (const auto& [name, result] : adapted["measures"].items())
    if (name.ends_with(".replaced") || name.ends_with(".share") || name.starts_with(stage + "."))
      if (const auto found = find_in(adapted, name))
        fmt::print("  {:28} {:>12.6g} {}\n", name, found->value, found->unit);
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
  ResumeOptions resume;
  resume.add_to(app);
  add_keep(app, o.run);
  if (const auto code = parse(app, argc, argv)) return *code;
  resume.apply(o.run);
  if (o.out.empty()) o.out = default_out(o.file).string() + "-apss";
  o.run.progress = stderr;

  const Document document(o.file, o.overrides);
  const CaseInput experiment = read_case(document);
  const std::string stage = deciding_stage(experiment, o.stage);
  const std::string region = region_to_find(document, experiment, o.region);
  const InfluenceField field = read_influence(run_balls(o, region, stage), o.by);
  const double threshold = threshold_for(field, o.share);
  write_influence(field, o.out / "influence.csv");
  const std::vector<std::string> overrides = with_region(
      o, region,
      fmt::format(R"({{kind = "field", file = {}, above = {:.17g}}})",  // JSON quotes as TOML does
                  Json(fs::absolute(o.out / "influence.csv").string()).dump(), threshold));
  fmt::print("influential area: {} above {:.4g} {} in the stage {}\n", o.by, threshold,
             si_unit_of(field.dimension), stage);
  fmt::print("its case:\n  trackbed run {}", quoted(o.file.string()));
  for (const std::string& value : overrides) fmt::print(" \\\n    --set {}", quoted(value));
  fmt::print("\n");
  if (o.prepare_only) return 0;
  print_results(o, stage, results_in(o, "adapted", overrides));
  fmt::print("results: {}\n", o.out.string());
  return 0;
}

}  // namespace trackbed
