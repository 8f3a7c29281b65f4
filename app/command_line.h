// Reading a subcommand's own command line.
#pragma once

#include <CLI/CLI.hpp>
#include <filesystem>
#include <optional>
#include <string>

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

/// Where results go when no folder is asked for: out/NAME of the folder that the file stands in.
inline std::filesystem::path default_out(const std::filesystem::path& file) {
  return std::filesystem::path("out") /
         std::filesystem::absolute(file).lexically_normal().parent_path().filename();
}

/// A word for the shell.
inline std::string quoted(const std::string& word) {
  std::string out = "'";
  for (char c : word) out += c == '\'' ? std::string("'\\''") : std::string(1, c);
  return out + "'";
}

}  // namespace trackbed
