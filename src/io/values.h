// One value of an input file: checks type, unit and range.
#pragma once

#include <filesystem>
#include <optional>

#include "io/diagnostics.h"
#include "io/schema.h"

namespace trackbed {

/// What all values of one file share.
struct Reading {
  std::filesystem::path
      folder;  // relative paths in the file start here; those of --set where the user stands
  Diagnostics& errors;
};

/// The value in SI; nothing, and at least one error, when it is wrong.
std::optional<Value> read_value(const Field& field, const Node& node, Reading& reading);

/// "a text", "a list": what stands there.
std::string_view kind_of_value(const Node& node);

}  // namespace trackbed
