// Wall time, for reports alone: nothing that is computed depends on it.
#pragma once

#include <chrono>

namespace trackbed {

class Stopwatch {
 public:
  /// Since it was made or started again [s].
  double seconds() const { return std::chrono::duration<double>(Clock::now() - start_).count(); }
  /// The same, and starts again.
  double lap() {
    const double time = seconds();
    start_ = Clock::now();
    return time;
  }

 private:
  using Clock = std::chrono::steady_clock;
  Clock::time_point start_ = Clock::now();
};

}  // namespace trackbed
