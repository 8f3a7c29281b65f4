#include "local_site.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <csignal>
#include <cstdlib>
#include <cstring>
#include <utility>

#include "base/error.h"
#include "io/files.h"

namespace trackbed {
namespace {

namespace fs = std::filesystem;

/// A number of a line "NAME:   1234 kB" of a file of /proc [kB]; 0 when there is none.
double kilobytes_in(const fs::path& file, const std::string& name) {
  std::error_code gone;
  if (!fs::exists(file, gone)) return 0;
  const std::string text = read_file(file);
  const std::size_t at = text.find(name + ":");
  return at == std::string::npos ? 0 : std::strtod(text.c_str() + at + name.size() + 1, nullptr);
}

/// In the new process: its messages go to the log, and it dies with its parent.
[[noreturn]] void become(const Job& job, pid_t parent) {
  ::prctl(PR_SET_PDEATHSIG, SIGKILL);
  if (::getppid() != parent) ::_exit(127);  // it is gone already
  const int file = ::open(log_of(job).c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0644);
  if (file >= 0) {
    ::dup2(file, STDOUT_FILENO);
    ::dup2(file, STDERR_FILENO);
    ::close(file);
  }
  std::vector<char*> argv{const_cast<char*>("trackbed")};
  for (const std::string& word : job.arguments) argv.push_back(const_cast<char*>(word.c_str()));
  argv.push_back(nullptr);
  ::execv("/proc/self/exe", argv.data());
  ::_exit(127);
}

/// As a shell tells it.
int exit_code(int status) {
  return WIFSIGNALED(status) ? 128 + WTERMSIG(status) : WEXITSTATUS(status);
}

}  // namespace

LocalSite::~LocalSite() {
  leave();
}

/// The runs that are there tell what one takes.
bool LocalSite::has_memory_for_another() {
  for (const auto& [process, job] : running_)
    peak_ = std::max(peak_, kilobytes_in(fmt::format("/proc/{}/status", process), "VmHWM"));
  if (running_.empty()) return true;
  return kilobytes_in("/proc/meminfo", "MemAvailable") > 1.3 * peak_;
}

void LocalSite::start(std::deque<Job>& waiting) {
  while (!waiting.empty() && running() < most_ && has_memory_for_another()) {
    Job job = std::move(waiting.front());
    waiting.pop_front();
    prepare_folder(job);
    const pid_t parent = ::getpid();
    const pid_t process = ::fork();
    if (process < 0) throw RunError(fmt::format("a process cannot be started: {}", std::strerror(errno)));
    if (process == 0) become(job, parent);
    running_.emplace(process, std::move(job));
  }
}

std::vector<Ended> LocalSite::ended() {
  std::vector<Ended> all;
  for (auto run = running_.begin(); run != running_.end();) {
    int status = 0;
    if (::waitpid(run->first, &status, WNOHANG) != run->first) {
      ++run;
      continue;
    }
    all.push_back(ended_with(run->second, exit_code(status)));
    run = running_.erase(run);
  }
  return all;
}

std::string LocalSite::leave() {
  for (const auto& [process, job] : running_) ::kill(process, SIGTERM);
  for (const auto& [process, job] : running_) ::waitpid(process, nullptr, 0);
  running_.clear();
  return "";
}

}  // namespace trackbed
