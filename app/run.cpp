// trackbed run: a case from its first stage to its results.
#include "lab/run.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "command_line.h"
#include "commands.h"
#include "io/echo.h"
#include "io/progress.h"
#include "kept.h"
#include "lab/track/track_run.h"
#include "resumable.h"

namespace trackbed {
namespace {

/// What most people look for first; those of walls and the rest are in summary.json.
void print_results(const Summary& summary) {
  constexpr std::array names{"stones",
                             "contacts",
                             "coordination_number",
                             "contact_force_mean",
                             "contact_force_max",
                             "porosity",
                             "porosity_of_pebbles",
                             "bed_height",
                             "unbalanced_ratio"};
  std::vector<Result> shown;
  for (const Result& r : summary.measures) {
    const auto dot = r.name.find('.');
    const bool of_stage = std::ranges::any_of(summary.stages, [&](const StageSummary& s) {
      return r.name.starts_with(s.name + ".") &&
             std::ranges::find(s.results, r.name.substr(s.name.size() + 1), &Result::name) != s.results.end();
    });
    if (of_stage || (dot == std::string::npos && std::ranges::find(names, r.name) != names.end()))
      shown.push_back(r);
  }
  std::size_t width = 0;
  for (const Result& r : shown) width = std::max(width, r.name.size());
  for (const Result& r : shown)
    fmt::print("  {:{}}  {:>12.6g} {}\n", r.name, width, r.value, si_unit_of(r.dimension));
}

/// The passage of a train takes minutes: it is not kept on its way, and begins anew.
int run_track_case(const Document& document, const RunOptions& options) {
  TrackCaseInput in;
  document.read(in);
  if (options.resume && results_of(echo(in), options.out)) return 0;
  const Summary summary = run_track(document, in, options);
  if (options.quiet) return 0;
  fmt::print("{}: {}\n", in.title, duration_text(summary.wall));
  for (const Result& r : summary.measures)
    fmt::print("  {:28}  {:>12.6g} {}\n", r.name, r.value, si_unit_of(r.dimension));
  fmt::print("results: {}\n", options.out.string());
  return 0;
}

}  // namespace

int run_command(int argc, char** argv) {
  std::filesystem::path file, out;
  std::vector<std::string> overrides;
  RunOptions options;
  ResumeOptions resume;
  CLI::App app("Runs a case and writes its results.", "trackbed run");
  app.add_option("case", file, "the case file (TOML)")->required();
  app.add_option("--out", out, "folder of the results; default: out/NAME of the case's folder");
  app.add_option("--set", overrides, "change a value of the case: stages.load.duration='2 s'")
      ->type_name("KEY=VALUE")
      ->allow_extra_args(false);
  app.add_option("--threads", options.threads, "number of threads; 0: one for each core")
      ->check(CLI::Range(0, 4096));
  resume.add_to(app);
  add_keep(app, options);
  app.add_flag("--quiet", options.quiet, "print nothing but errors");
  if (const auto code = parse(app, argc, argv)) return *code;

  const Document document(file, overrides);
  options.out = out.empty() ? default_out(file) : out;
  options.progress = stderr;
  resume.apply(options);
  if (is_track_case(document)) return run_track_case(document, options);
  CaseInput experiment;
  document.read(experiment);
  if (options.resume && results_of(echo(experiment), options.out)) return 0;
  const Summary summary = run_until_signal(document, experiment, options);
  if (options.quiet) return 0;
  fmt::print("{}: {} stages in {}\n", experiment.title, summary.stages.size(), duration_text(summary.wall));
  print_results(summary);
  fmt::print("results: {}\n", options.out.string());
  return 0;
}

}  // namespace trackbed
