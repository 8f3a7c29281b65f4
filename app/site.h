// Where the members of a study run: on this machine, or in a cluster's queue.
#pragma once

#include <deque>
#include <filesystem>
#include <string>
#include <vector>

namespace trackbed {

/// A member that is to be run.
struct Job {
  std::string name;
  std::filesystem::path folder;        // of its results
  std::vector<std::string> arguments;  // of this program
  std::string input;                   // fingerprint of the case as it was understood
};

/// How a run ended.
struct Ended {
  std::string name;
  bool succeeded = false;
  bool was_stopped = false;  // not by its own fault: it may be tried again
  std::string cause;         // "exit 1: " and the last line it wrote
};

class Site {
 public:
  virtual ~Site() = default;

  /// Starts those from the front that there is room for, or that run already, and takes them off the list.
  virtual void start(std::deque<Job>& waiting) = 0;

  /// Those that have ended since the last call.
  virtual std::vector<Ended> ended() = 0;

  virtual int running() const = 0;  ///< at this moment

  /// The study stops waiting. Returns what becomes of those that run, for the user; empty: they are stopped.
  virtual std::string leave() = 0;
};

/// Makes the folder of a member anew, unless the same member was stopped there and may go on.
void prepare_folder(const Job& job);

/// Where the messages of a run go.
std::filesystem::path log_of(const Job& job);

/// "exit 1" or "signal 9", and the last line of the log. `code` as a shell has it: 128 and more for signals.
Ended ended_with(const Job& job, int code);

}  // namespace trackbed
