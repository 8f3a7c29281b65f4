// trackbed couple: a train's passage and the bed under some of its sleepers, until they agree.
#include <fmt/format.h>

#include "command_line.h"
#include "commands.h"
#include "io/progress.h"
#include "kept.h"
#include "lab/coupling.h"

namespace trackbed {
namespace {

void print_round(const SleeperRange& range, const CouplingRound& r) {
  fmt::print(
      "round {}, sleepers {} to {}: pressed with {:.2f} kN, {:.1f} kN/mm, settled by {:.3f} mm; peak in the "
      "passage "
      "{:.2f} kN, change {:.2g}\n",
      r.round, range.from, range.to, 1e-3 * r.load, 1e-6 * r.curve.secant(), 1e3 * r.curve.settlement,
      1e-3 * r.peak, r.change);
  std::fflush(stdout);
}

}  // namespace

int couple_command(int argc, char** argv) {
  std::filesystem::path file, out;
  std::vector<std::string> overrides;
  RunOptions options;
  CLI::App app(
      "Couples a track with a bed of stones: the train passes, a bed is pressed as hard as the sleepers "
      "were, the "
      "train passes over what the bed has shown, until the forces stay.",
      "trackbed couple");
  app.add_option("coupling", file, "the file of the coupling (TOML)")->required();
  app.add_option("--out", out, "folder of the results; default: out/NAME of the file");
  app.add_option("--set", overrides, "change a value of the coupling")
      ->type_name("KEY=VALUE")
      ->allow_extra_args(false);
  app.add_option("--threads", options.threads, "number of threads; 0: one for each core")
      ->check(CLI::Range(0, 4096));
  add_keep(app, options);
  app.add_flag("--quiet", options.quiet, "print nothing but errors");
  if (const auto code = parse(app, argc, argv)) return *code;

  const Document document(file, overrides);
  CouplingInput in;
  document.read(in);
  options.out = out.empty() ? std::filesystem::path("out") / file.stem() : out;
  options.progress = stderr;
  const auto rounds = run_coupling(document, in, options, [&](const CouplingRound& r) {
    if (!options.quiet) print_round(in.sleepers[r.range], r);
  });
  if (options.quiet) return 0;
  fmt::print("{}: agreed after {} rounds\nresults: {}, the last passage in passage-{}\n", in.title,
             rounds.back().round, options.out.string(), rounds.back().round);
  return 0;
}

}  // namespace trackbed
