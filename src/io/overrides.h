// Values given on the command line with --set, put in the place of those in the file.
#pragma once

#include <optional>
#include <string_view>
#include <vector>

#include "io/diagnostics.h"

namespace trackbed {

/// Puts each override of `source` into the tree: "key=value" with a dotted key and a TOML value; a bare word
/// is a text. Elements of a list are named by their index from 0 or by the value of their key `name`. A table
/// that is not there is made; whether its keys are known is for the reader to say.
void apply_overrides(Node& root, const Source& source, Diagnostics& errors);

/// "stages.load.time" -> its parts.
std::vector<std::string_view> parts_of(std::string_view dotted_key);

/// The item of a table by key, of a list by index or name; null when there is none.
Node* step_into(Node& node, std::string_view part);

}  // namespace trackbed
