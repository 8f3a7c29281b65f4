// Where the program keeps what takes long to work out.
#pragma once

#include <cstdlib>
#include <filesystem>

#include "base/error.h"

namespace trackbed {

/// $XDG_CACHE_HOME/trackbed, else ~/.cache/trackbed. Throws InputError when neither is known.
inline std::filesystem::path default_cache() {
  namespace fs = std::filesystem;
  if (const char* cache = std::getenv("XDG_CACHE_HOME"); cache && *cache) return fs::path(cache) / "trackbed";
  if (const char* home = std::getenv("HOME"); home && *home) return fs::path(home) / ".cache" / "trackbed";
  throw InputError("neither XDG_CACHE_HOME nor HOME says where it can be kept: give a folder with --keep");
}

}  // namespace trackbed
