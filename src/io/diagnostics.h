// Errors of an input file, shown where they stand:
//
//   cases/box/case.toml:14:12: error: friction cannot be negative
//     14 | friction = -0.5
//        |            ^~~~
//     hint: give a value from 0 to 10
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "io/toml.h"

namespace trackbed {

/// The texts that places point into.
struct Source {
  std::string name;                    // of the file
  std::string text;                    //
  std::vector<std::string> overrides;  // as given to --set
};

/// Collects the errors of one file.
class Diagnostics {
 public:
  explicit Diagnostics(const Source& source) : source_(source) {}

  void add(const Place& place, std::string problem, std::string hint = {});
  std::size_t size() const { return errors_.size(); }
  /// Throws InputError with the first 20 in the order of their places; does nothing when there are none.
  void throw_if_any() const;

 private:
  struct Error {
    Place place;
    std::string problem, hint;
  };
  std::string show(const Error& error) const;

  const Source& source_;
  std::vector<Error> errors_;
};

}  // namespace trackbed
