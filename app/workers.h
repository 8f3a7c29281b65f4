// Runs of this program as processes of their own, so that one that fails takes nothing with it.
#pragma once

#include <sys/types.h>

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace trackbed {

/// How a process ended.
struct Ended {
  pid_t process = 0;
  bool succeeded = false;
  bool was_stopped = false;  // by a signal
  std::string cause;         // "exit 1" or "signal 9", and the last line it wrote
};

class Workers {
 public:
  ~Workers();  ///< stops those that run

  /// Starts `trackbed ARGUMENTS...` with its messages going to a file. It ends when this process ends,
  /// however that happens. Throws RunError when it cannot be started.
  pid_t start(const std::vector<std::string>& arguments, const std::filesystem::path& log);

  /// One that has ended since the last call; nothing when none has.
  std::optional<Ended> next_ended();

  int running() const { return static_cast<int>(logs_.size()); }

  /// Asks all to stop and waits for them.
  void stop();

 private:
  struct Log {
    pid_t process;
    std::filesystem::path path;
  };
  std::vector<Log> logs_;
};

}  // namespace trackbed
