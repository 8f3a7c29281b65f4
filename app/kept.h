// Where the program keeps what takes long to work out.
#pragma once

#include <CLI/CLI.hpp>
#include <cstdlib>
#include <filesystem>

#include "lab/run.h"

namespace trackbed {

/// $XDG_CACHE_HOME/trackbed, else ~/.cache/trackbed; empty when neither is known.
inline std::filesystem::path default_cache() {
  namespace fs = std::filesystem;
  if (const char* cache = std::getenv("XDG_CACHE_HOME"); cache && *cache) return fs::path(cache) / "trackbed";
  if (const char* home = std::getenv("HOME"); home && *home) return fs::path(home) / ".cache" / "trackbed";
  return {};
}

/// --keep, for options.keep.
inline void add_keep(CLI::App& app, RunOptions& options) {
  options.keep = default_cache();
  app.add_option("--keep", options.keep,
                 "folder where the ends of the stages in record.keep and the reduced ground of a track are "
                 "kept; default: ~/.cache/trackbed");
}

}  // namespace trackbed
