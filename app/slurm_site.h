// Members as tasks of job arrays of a Slurm that is there already; nothing is asked of it but sbatch, squeue
// and scancel. The study's folder must be seen by its nodes under the same name.
#pragma once

#include <chrono>
#include <filesystem>
#include <map>
#include <optional>
#include <utility>

#include "site.h"

namespace trackbed {

struct SlurmOptions {
  int threads = 1;                   // of each member
  int most = 0;                      // members at a time; 0: as many as Slurm lets
  std::vector<std::string> further;  // options of sbatch: "--partition=short"
};

class SlurmSite : public Site {
 public:
  /// `folder`: of job scripts and of what is known of the arrays, so that a study that is called again finds
  /// them. Throws InputError when there is no Slurm.
  SlurmSite(std::filesystem::path folder, SlurmOptions options);

  void start(std::deque<Job>& waiting) override;
  std::vector<Ended> ended() override;
  int running() const override;
  std::string leave() override;

  /// The jobs of an earlier call that Slurm still has; empty as well when there is no Slurm.
  static std::vector<std::string> jobs_alive(const std::filesystem::path& folder);

 private:
  using Clock = std::chrono::steady_clock;
  using Place = std::pair<std::string, int>;  // name of the array, index in it
  struct Task {
    Place place = {};
    std::string input = {};
    std::string state = {};  // last one that was seen, while it was not over
    bool is_cancelled = false;
    std::optional<Clock::time_point> gone = {};  // since when it is over without having left its exit code
  };
  struct Array {
    std::string job;                   // Slurm's number; empty: not known yet
    std::vector<std::string> members;  // by index; empty: its end is known
    std::vector<std::string> inputs;
  };

  void read_arrays();
  void write_array(const std::string& name) const;
  void submit(std::vector<Job> jobs);
  std::string ask();
  std::string state_of(const Place& place) const;
  bool is_held_back(const Job& job);
  std::optional<Ended> end_of(const Job& job, Task& task) const;
  void forget(const std::string& member);

  std::filesystem::path folder_;
  SlurmOptions options_;
  std::map<std::string, Array> arrays_;  // by name
  std::map<std::string, Task> tasks_;    // by member: all whose end is not known
  std::map<std::string, Job> awaited_;   // those of them that the study waits for
  std::map<Place, std::string> states_;  // as Slurm told last
  bool knows_states_ = false, is_silent_ = false;
  Clock::time_point asked_;
  std::chrono::milliseconds pause_{1000};  // before it is asked again
};

}  // namespace trackbed
