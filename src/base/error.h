// The two ways a Trackbed operation can fail. The library throws; only the program prints and exits.
#pragma once

#include <stdexcept>
#include <string>

namespace trackbed {

/// The user's input is wrong: the message names the file (and line, where there is one), what is wrong
/// and what would be right. The program exits with 2.
class InputError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// A run that started well cannot go on: the message names stage, step, stone and cause. Exits with 1.
class RunError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

}  // namespace trackbed
