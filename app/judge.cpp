// trackbed judge: which runs of one model are like those of another, by a rule in a file.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "command_line.h"
#include "commands.h"
#include "io/files.h"
#include "io/read.h"
#include "lab/study/judge.h"

namespace trackbed {
namespace {

namespace fs = std::filesystem;

std::string verdict_on(const Judged& run) {
  const std::string verdict = run.refusal.empty() ? "accepted" : "refused: " + run.refusal;
  if (!run.is_reference) return verdict;
  return std::isnan(run.likeness.distance) ? "the only reference"
                                           : "a reference, beside the others: " + verdict;
}

void print_judgement(const std::vector<Judged>& runs) {
  fmt::print("{:32} {:>9} {:>9} {:>9}\n", "", "distance", "place", "share");
  for (const Judged& run : runs)
    fmt::print("{:32} {:9.3f} {:9.3f} {:9.3f}  {}\n", run.name, run.likeness.distance, run.likeness.place,
               run.likeness.share, verdict_on(run));
  const auto members = std::ranges::count(runs, false, &Judged::is_reference);
  const auto accepted =
      std::ranges::count_if(runs, [](const Judged& run) { return !run.is_reference && run.refusal.empty(); });
  fmt::print("{} of {} members are accepted\n", accepted, members);
}

}  // namespace

int judge_command(int argc, char** argv) {
  fs::path file, out = "out/judge";
  std::vector<fs::path> members, references;
  CLI::App app(
      "Judges runs by a rule written down before: how a body bears on the stones in them, beside "
      "runs of another model. Gives measures for accepted, refused and all.",
      "trackbed judge");
  app.add_option("rule", file, "the rule (TOML)")->required();
  app.add_option("--members", members, "folders of the runs to judge, or of a study")->required();
  app.add_option("--references", references, "folders of the runs they are compared with, or of a study")
      ->required();
  app.add_option("--out", out, "folder of the results")->capture_default_str();
  if (const auto code = parse(app, argc, argv)) return *code;

  const Document document(file);
  JudgeInput rule;
  document.read(rule);
  const std::vector<Judged> runs = judge(rule, members, references);
  make_folder(out);
  write_judgement(rule, runs, out);
  print_judgement(runs);
  fmt::print("results: {} and judge-table.csv\n", (out / "judge.csv").string());
  return 0;
}

}  // namespace trackbed
