#include "workers.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <csignal>
#include <cstring>

#include "base/error.h"
#include "io/files.h"

namespace trackbed {
namespace {

/// What the user wants to know of a log: its last line that is not empty.
std::string last_line(const std::filesystem::path& log) {
  std::string text = std::filesystem::exists(log) ? read_file(log) : "";
  while (!text.empty() && (text.back() == '\n' || text.back() == ' ')) text.pop_back();
  // Messages of a failed run are followed by an indented line that says where its last state is.
  std::size_t from = text.rfind('\n');
  while (from != std::string::npos && from + 1 < text.size() && text[from + 1] == ' ') {
    text.resize(from);
    from = text.rfind('\n');
  }
  return from == std::string::npos ? text : text.substr(from + 1);
}

/// In the new process: its messages go to the log, and it dies with its parent.
[[noreturn]] void become(const std::vector<std::string>& arguments, const std::filesystem::path& log,
                         pid_t parent) {
  ::prctl(PR_SET_PDEATHSIG, SIGKILL);
  if (::getppid() != parent) ::_exit(127);  // it is gone already
  const int file = ::open(log.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0644);
  if (file >= 0) {
    ::dup2(file, STDOUT_FILENO);
    ::dup2(file, STDERR_FILENO);
    ::close(file);
  }
  std::vector<char*> argv{const_cast<char*>("trackbed")};
  for (const std::string& word : arguments) argv.push_back(const_cast<char*>(word.c_str()));
  argv.push_back(nullptr);
  ::execv("/proc/self/exe", argv.data());
  ::_exit(127);
}

}  // namespace

Workers::~Workers() {
  stop();
}

pid_t Workers::start(const std::vector<std::string>& arguments, const std::filesystem::path& log) {
  const pid_t parent = ::getpid();
  const pid_t process = ::fork();
  if (process < 0) throw RunError(fmt::format("a process cannot be started: {}", std::strerror(errno)));
  if (process == 0) become(arguments, log, parent);
  logs_.push_back({process, log});
  return process;
}

std::optional<Ended> Workers::next_ended() {
  for (std::size_t k = 0; k < logs_.size(); ++k) {
    int status = 0;
    if (::waitpid(logs_[k].process, &status, WNOHANG) != logs_[k].process) continue;
    Ended ended{logs_[k].process, WIFEXITED(status) && WEXITSTATUS(status) == 0, WIFSIGNALED(status), ""};
    if (!ended.succeeded) {
      const std::string how = ended.was_stopped ? fmt::format("signal {}", WTERMSIG(status))
                                                : fmt::format("exit {}", WEXITSTATUS(status));
      const std::string said = last_line(logs_[k].path);
      ended.cause = said.empty() ? how : fmt::format("{}: {}", how, said);
    }
    logs_.erase(logs_.begin() + static_cast<std::ptrdiff_t>(k));
    return ended;
  }
  return std::nullopt;
}

void Workers::stop() {
  for (const Log& log : logs_) ::kill(log.process, SIGTERM);
  for (const Log& log : logs_) ::waitpid(log.process, nullptr, 0);
  logs_.clear();
}

}  // namespace trackbed
