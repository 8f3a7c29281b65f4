#include "scenes/study_process.h"

#include <fcntl.h>
#include <signal.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <fstream>
#include <sstream>
#include <stdexcept>

#include "io/files.h"

namespace trackbed {
namespace {

int code_of(int status) {
  return WIFEXITED(status) ? WEXITSTATUS(status) : -WTERMSIG(status);
}

}  // namespace

const char* const balls_in_a_box = R"toml(
title = "Balls in a box"
stones.fidelity = "ball"
materials.ballast = { kn = "1e6 N/m", ks = "1e6 N/m", friction = 0.5, density = "2650 kg/m^3" }
walls.box = { kind = "box", size = ["0.2 m", "0.2 m", "0.1 m"], material = "ballast" }
record.picture = false
record.tables = false
record.paraview_stones = "none"
[[stages]]
kind = "fill"
[[stages]]
kind = "settle"
)toml";

StudyProcess::StudyProcess(const std::string& program, const std::filesystem::path& file,
                           const std::filesystem::path& out, const std::vector<std::string>& options) {
  std::vector<std::string> words{program, "study", file.string(), "--out", out.string()};
  words.insert(words.end(), options.begin(), options.end());
  std::vector<char*> argv;
  for (std::string& word : words) argv.push_back(word.data());
  argv.push_back(nullptr);
  const std::string messages = out.parent_path() / "messages.txt";
  const int log = ::open(messages.c_str(), O_WRONLY | O_CREAT | O_APPEND | O_CLOEXEC, 0644);
  const pid_t parent = ::getpid();
  process_ = ::fork();
  if (process_ != 0) {
    ::close(log);
    if (process_ < 0) throw std::runtime_error("cannot be started: " + program);
    return;
  }
  ::prctl(PR_SET_PDEATHSIG, SIGKILL);  // nothing stays behind when the test is killed
  ::dup2(log, STDOUT_FILENO);
  ::dup2(log, STDERR_FILENO);
  if (::getppid() == parent) ::execv(program.c_str(), argv.data());
  ::_exit(127);
}

StudyProcess::~StudyProcess() {
  kill();
}

int StudyProcess::wait() {
  int status = 0;
  if (process_ > 0 && ::waitpid(process_, &status, 0) == process_) {
    code_ = code_of(status);
    process_ = 0;
  }
  return code_;
}

bool StudyProcess::has_ended() {
  int status = 0;
  if (process_ > 0 && ::waitpid(process_, &status, WNOHANG) == process_) {
    code_ = code_of(status);
    process_ = 0;
  }
  return process_ == 0;
}

void StudyProcess::ask_to_stop() {
  if (process_ > 0) ::kill(process_, SIGTERM);
}

void StudyProcess::kill() {
  if (process_ > 0) ::kill(process_, SIGKILL);
  wait();
}

std::vector<pid_t> StudyProcess::workers() const {
  const std::string process = std::to_string(process_);
  std::ifstream file("/proc/" + process + "/task/" + process + "/children");
  std::vector<pid_t> all;
  for (pid_t child = 0; file >> child;) all.push_back(child);
  return all;
}

std::string members_of(const std::filesystem::path& out) {
  std::istringstream in(read_file(out / "study.csv"));
  std::string all, line;
  while (std::getline(in, line)) {
    const std::size_t last = line.rfind(','), before = line.rfind(',', last - 1);
    all += line.substr(0, before) + line.substr(last) + "\n";
  }
  return all;
}

}  // namespace trackbed
