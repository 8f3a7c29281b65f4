// Reading a subcommand's own command line.
#pragma once

#include <CLI/CLI.hpp>
#include <optional>

namespace trackbed {

/// Fills what the options of `app` are bound to. Returns the exit code when there is nothing more to do: 0
/// after
/// --help, 2 for a wrong command line, which is said on stderr.
inline std::optional<int> parse(CLI::App& app, int argc, char** argv) {
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? 0 : 2;
  }
  return std::nullopt;
}

}  // namespace trackbed
