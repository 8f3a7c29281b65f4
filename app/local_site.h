// Members as processes on this machine, so that one that fails takes nothing with it.
#pragma once

#include <sys/types.h>

#include <map>

#include "site.h"

namespace trackbed {

class LocalSite : public Site {
 public:
  /// `most`: how many run at a time, where memory allows it.
  explicit LocalSite(int most) : most_(most) {}
  ~LocalSite() override;

  void start(std::deque<Job>& waiting) override;
  std::vector<Ended> ended() override;
  int running() const override { return static_cast<int>(running_.size()); }
  std::string leave() override;

 private:
  bool has_memory_for_another();

  int most_;
  double peak_ = 0;  // memory of the largest run so far [kB]
  std::map<pid_t, Job> running_;
};

}  // namespace trackbed
