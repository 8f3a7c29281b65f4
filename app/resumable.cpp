#include "resumable.h"

#include <fmt/format.h>

#include <csignal>
#include <cstdlib>

#include "base/error.h"
#include "lab/study/results.h"

namespace trackbed {
namespace {

volatile std::sig_atomic_t stop_signal = 0;

void stop_on_signals() {
  for (const int signal : {SIGTERM, SIGINT})
    std::signal(signal, [](int number) {
      stop_signal = number;
      std::signal(number, SIG_DFL);
    });
}

/// Ends as the signal would have ended it, so that whoever sent it sees that.
[[noreturn]] void end_by_signal() {
  std::signal(stop_signal, SIG_DFL);
  std::raise(stop_signal);
  std::abort();  // not reached
}

double seconds(const std::string& text, const char* option) {
  const auto value = parse_quantity(text, Dimension::time);
  if (const auto* wrong = std::get_if<std::string>(&value))
    throw InputError(fmt::format("{} {}: {}", option, text, *wrong));
  return std::get<double>(value);
}

}  // namespace

void ResumeOptions::add_to(CLI::App& app) {
  app.add_flag(
      "--resume", resume_,
      "go on from the last checkpoint in the folder of the results; from the beginning where there is "
      "none");
  app.add_option("--checkpoint-every", every_,
                 "wall time between two checkpoints; there is one at each stage's end and when the run is "
                 "stopped (SIGTERM, SIGINT)")
      ->capture_default_str();
}

void ResumeOptions::apply(RunOptions& options) const {
  options.resume = resume_;
  options.checkpoint_every = seconds(every_, "--checkpoint-every");
}

std::optional<nlohmann::ordered_json> results_of(const nlohmann::ordered_json& input,
                                                 const std::filesystem::path& folder) {
  if (std::filesystem::exists(folder / "checkpoint")) return std::nullopt;
  Member alone;  // what its folder says is judged as in a study
  alone.input = input;
  Outcome outcome = outcome_of(alone, folder);
  if (outcome.status != MemberStatus::done) return std::nullopt;
  fmt::print("{} holds the results of this case already\n", folder.string());
  return std::move(outcome.summary);
}

Summary run_until_signal(const Document& document, const CaseInput& experiment, RunOptions options) {
  options.stop = [] { return stop_signal != 0; };
  stop_on_signals();
  try {
    return run(document, experiment, options);
  } catch (const Stopped& stopped) {
    fmt::print(stderr, "trackbed: {}\n", stopped.what());
    end_by_signal();
  }
}

}  // namespace trackbed
