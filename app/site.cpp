#include "site.h"

#include <fmt/format.h>

#include "io/files.h"

namespace trackbed {
namespace {

namespace fs = std::filesystem;

/// What the user wants to know of a log: its last line that is not empty.
std::string last_line(const fs::path& log) {
  std::string text = fs::exists(log) ? read_file(log) : "";
  while (!text.empty() && (text.back() == '\n' || text.back() == ' ')) text.pop_back();
  // Messages of a failed run are followed by an indented line that says where its last state is.
  std::size_t from = text.rfind('\n');
  while (from != std::string::npos && from + 1 < text.size() && text[from + 1] == ' ') {
    text.resize(from);
    from = text.rfind('\n');
  }
  return from == std::string::npos ? text : text.substr(from + 1);
}

}  // namespace

void prepare_folder(const Job& job) {
  const fs::path input = job.folder / "input.txt";
  const bool was_stopped = fs::exists(job.folder / "checkpoint") && fs::exists(input) &&
                           read_file(input) == job.input && !fs::exists(job.folder / "failure.json");
  std::error_code none;
  if (was_stopped) {
    fs::remove(job.folder / "exit", none);  // of the run that was stopped
    return;
  }
  fs::remove_all(job.folder);
  make_folder(job.folder);
  write_file(input, job.input);
}

fs::path log_of(const Job& job) {
  return job.folder / "log.txt";
}

Ended ended_with(const Job& job, int code) {
  Ended ended{job.name, code == 0, code > 128, ""};
  if (ended.succeeded) return ended;
  const std::string how =
      ended.was_stopped ? fmt::format("signal {}", code - 128) : fmt::format("exit {}", code);
  const std::string said = last_line(log_of(job));
  ended.cause = said.empty() ? how : fmt::format("{}: {}", how, said);
  return ended;
}

}  // namespace trackbed
