// Tells the user what may stand in an input file, from the same declarations that read it.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "io/schema.h"

namespace trackbed {

/// One table of the input: its keys, in the order of their declaration.
struct Page {
  struct Row {
    std::string key;       // "contact.friction"; "materials.NAME.density"; "stages[].name"
    std::string type;      // "length [m]", "one of: linear, hertz"
    std::string fallback;  // the default; "required" or "-" (may be absent)
    std::string range;
    std::string meaning;
  };
  struct Result {
    std::string name, unit, meaning;
  };
  std::string name;     // "settle"
  std::string meaning;  //
  std::vector<Row> rows;
  std::vector<Result> results = {};  // what the run leaves because of it
};

/// The pages of one input struct: itself, and every kind of each registry it leads to.
struct Description {
  Page top;
  std::vector<std::pair<std::string, std::vector<Page>>> families;  // "stage" -> its kinds

  /// The page called `name`: a kind ("settle"), or the rows of the top page below a key ("contact").
  /// Throws InputError that names the nearest.
  Page find(std::string_view name) const;
};

/// Walks the declaration.
Description describe_with(std::string name, std::string meaning,
                          const std::function<void(Fields&)>& declare_all);

template <class T>
Description describe(std::string name, std::string meaning) {
  T defaults{};
  return describe_with(std::move(name), std::move(meaning), [&](Fields& f) { declare(f, defaults); });
}

std::string to_text(const Page& page);                    ///< for a terminal
std::string to_text(const Description& description);      ///< top page and the list of kinds
std::string to_markdown(const Description& description);  ///< docs/input.md

}  // namespace trackbed
