// Runs that may be stopped, and taken up again by the same command.
#pragma once

#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>

#include "lab/run.h"

namespace trackbed {

/// --resume and --checkpoint-every. `apply`, when the command line is read, throws InputError for a wrong
/// time.
class ResumeOptions {
 public:
  void add_to(CLI::App& app);
  void apply(RunOptions& options) const;

 private:
  bool resume_ = false;
  std::string every_ = "10 min";
};

/// summary.json of a folder that holds the results of this very input already; says so.
std::optional<nlohmann::ordered_json> results_of(const nlohmann::ordered_json& input,
                                                 const std::filesystem::path& folder);

/// As run. SIGTERM or SIGINT lets it leave a checkpoint; then the process ends as the signal would have ended
/// it. A second one ends it at once.
Summary run_until_signal(const Document& document, const CaseInput& experiment, RunOptions options);

}  // namespace trackbed
