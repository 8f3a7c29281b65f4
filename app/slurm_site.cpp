#include "slurm_site.h"

#include <fmt/format.h>
#include <sys/wait.h>

#include <algorithm>
#include <array>
#include <cstdio>
#include <cstdlib>
#include <nlohmann/json.hpp>
#include <set>
#include <sstream>

#include "base/error.h"
#include "base/hash.h"
#include "command_line.h"
#include "io/files.h"

namespace trackbed {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

constexpr std::size_t most_tasks = 1000;      // Slurm's own limit, unless its MaxArraySize says otherwise
constexpr std::chrono::seconds patience{60};  // until files of another machine can be seen
constexpr std::chrono::milliseconds first_pause{1000}, longest_pause{15000};

struct Answer {
  int code = 0;
  std::string text;  // of both streams
};

Answer ask_shell(const std::string& command) {
  std::FILE* pipe = ::popen((command + " 2>&1").c_str(), "r");
  if (!pipe) throw RunError(fmt::format("cannot be started: {}", command));
  Answer answer;
  std::array<char, 4096> part{};
  std::size_t n = 0;
  while ((n = std::fread(part.data(), 1, part.size(), pipe)) > 0) answer.text.append(part.data(), n);
  const int status = ::pclose(pipe);
  answer.code = WIFEXITED(status) ? WEXITSTATUS(status) : 1;
  while (!answer.text.empty() && answer.text.back() == '\n') answer.text.pop_back();
  return answer;
}

bool has_program(const std::string& name) {
  return ask_shell("command -v " + name).code == 0;
}

/// Slurm has not done with a task in these states.
bool is_live(const std::string& state) {
  static const std::set<std::string> over{"COMPLETED", "FAILED",        "CANCELLED", "TIMEOUT",   "DEADLINE",
                                          "NODE_FAIL", "OUT_OF_MEMORY", "PREEMPTED", "BOOT_FAIL", "REVOKED"};
  return !state.empty() && !over.contains(state);
}

/// What Slurm ended of its own accord, in words; empty for other states.
std::string verdict_of(const std::string& state) {
  if (state == "CANCELLED") return "cancelled in Slurm";
  if (state == "TIMEOUT") return "Slurm's time limit: raise it with --sbatch=--time=...";
  if (state == "OUT_OF_MEMORY") return "Slurm's memory limit: raise it with --sbatch=--mem=...";
  if (state == "DEADLINE") return "Slurm's deadline";
  return "";
}

/// Arrays' names are unique, so that one is found even when its number was not written down in time.
std::string new_name(const fs::path& folder) {
  Hash where;
  where.add(fs::absolute(folder).string());
  for (int k = 1;; ++k) {
    std::string name = fmt::format("trackbed-{:08x}-{}", where.value() & 0xffffffff, k);
    if (!fs::exists(folder / name)) return name;
  }
}

std::string script_of(const std::vector<Job>& jobs) {
  std::string text = R"(#!/bin/bash
# Written by trackbed study: one member for each index of the array. The file "exit" in the member's folder
# is its exit code, written when all its results are.
member() {
  folder=$1; shift
  rm -f "$folder/exit"
  "$@" > "$folder/log.txt" 2>&1
  code=$?
  echo $code > "$folder/exit.new" && mv "$folder/exit.new" "$folder/exit"
  exit $code
}
case $SLURM_ARRAY_TASK_ID in
)";
  const std::string program = fs::read_symlink("/proc/self/exe").string();
  for (std::size_t k = 0; k < jobs.size(); ++k) {
    text += fmt::format("{}) member {} {}", k, quoted(jobs[k].folder.string()), quoted(program));
    for (const std::string& word : jobs[k].arguments) text += " " + quoted(word);
    text += " ;;\n";
  }
  return text + "esac\n";
}

}  // namespace

SlurmSite::SlurmSite(fs::path folder, SlurmOptions options)
    : folder_(fs::absolute(folder)), options_(std::move(options)) {
  for (const char* program : {"sbatch", "squeue", "scancel"})
    if (!has_program(program))
      throw InputError(fmt::format(
          "--on slurm: there is no {} on this machine; call this where jobs are submitted to Slurm",
          program));
  read_arrays();
  const std::string complaint = ask();
  if (!complaint.empty()) throw InputError("--on slurm: Slurm does not answer\n" + complaint);
  // A call that was killed before sbatch ended has left arrays that Slurm never heard of.
  std::erase_if(tasks_, [&](const auto& task) { return arrays_.at(task.second.place.first).job.empty(); });
}

void SlurmSite::read_arrays() {
  if (!fs::exists(folder_)) return;
  std::vector<fs::path> files;
  for (const auto& entry : fs::directory_iterator(folder_))
    if (fs::exists(entry.path() / "members.json")) files.push_back(entry.path() / "members.json");
  for (const fs::path& file : files) {
    const Json json = Json::parse(read_file(file));
    const std::string name = file.parent_path().filename().string();
    Array& array = arrays_[name];
    array.job = json["job"].get<std::string>();
    for (const Json& member : json["members"]) {
      array.members.push_back(member["name"].get<std::string>());
      array.inputs.push_back(member["input"].get<std::string>());
      const int index = static_cast<int>(array.members.size()) - 1;
      if (!array.members.back().empty()) tasks_[array.members.back()] = {{name, index}, array.inputs.back()};
    }
  }
}

void SlurmSite::write_array(const std::string& name) const {
  const Array& array = arrays_.at(name);
  Json members = Json::array();
  for (std::size_t k = 0; k < array.members.size(); ++k)
    members.push_back({{"name", array.members[k]}, {"input", array.inputs[k]}});
  write_file(folder_ / name / "members.json", Json{{"job", array.job}, {"members", members}}.dump(1));
}

/// Its end is known: nobody waits for it again, in later calls either.
void SlurmSite::forget(const std::string& member) {
  const Place place = tasks_.at(member).place;
  tasks_.erase(member);
  arrays_.at(place.first).members[static_cast<std::size_t>(place.second)].clear();
  write_array(place.first);
}

/// Finds out how the tasks are getting on; returns what is wrong when Slurm does not answer.
std::string SlurmSite::ask() {
  // Tasks that are over stay in the list for some minutes, with the state they ended in.
  const Answer answer = ask_shell("squeue --me --noheader --array --states=all --format='%j %F %K %T'");
  asked_ = Clock::now();
  if (answer.code != 0) return fmt::format("squeue: exit {}\n{}", answer.code, answer.text);
  std::map<Place, std::string> states;
  std::istringstream lines(answer.text);
  for (std::string line; std::getline(lines, line);) {
    std::istringstream words(line);
    std::string name, job, index, state;
    words >> name >> job >> index >> state;
    const auto array = arrays_.find(name);
    if (array == arrays_.end() || index.find_first_not_of("0123456789") != std::string::npos) continue;
    if (array->second.job.empty()) {
      array->second.job = job;
      write_array(name);
    }
    if (array->second.job == job) states[{name, std::atoi(index.c_str())}] = state;
  }
  const bool is_news = states != states_;
  pause_ = is_news ? first_pause : std::min(2 * pause_, longest_pause);
  states_ = std::move(states);
  knows_states_ = true;
  return "";
}

std::string SlurmSite::state_of(const Place& place) const {
  const auto found = states_.find(place);
  return found == states_.end() ? "" : found->second;
}

/// Whether a task of an earlier study, with another input, is still at work in the member's folder.
bool SlurmSite::is_held_back(const Job& job) {
  const auto found = tasks_.find(job.name);
  if (found == tasks_.end()) return false;
  Task& task = found->second;
  if (!is_live(state_of(task.place))) {
    forget(job.name);
    return false;
  }
  if (!task.is_cancelled)
    ask_shell(fmt::format("scancel {}_{}", arrays_.at(task.place.first).job, task.place.second));
  task.is_cancelled = true;
  return true;
}

void SlurmSite::start(std::deque<Job>& waiting) {
  if (!knows_states_) return;
  std::deque<Job> later;
  std::vector<Job> now;
  std::map<std::string, int> found;
  for (Job& job : waiting) {
    const auto task = tasks_.find(job.name);
    if (task != tasks_.end() && task->second.input == job.input) {
      ++found[arrays_.at(task->second.place.first).job];
      awaited_[job.name] = std::move(job);
    } else if (is_held_back(job) || now.size() == most_tasks) {
      later.push_back(std::move(job));
    } else {
      now.push_back(std::move(job));
    }
  }
  waiting = std::move(later);
  for (const auto& [job, n] : found) fmt::print("Slurm job {}: {} members of an earlier call\n", job, n);
  std::fflush(stdout);
  if (!now.empty()) submit(std::move(now));
}

void SlurmSite::submit(std::vector<Job> jobs) {
  const std::string name = new_name(folder_);
  make_folder(folder_ / name);
  Array& array = arrays_[name];
  for (const Job& job : jobs) {
    prepare_folder(job);
    array.members.push_back(job.name);
    array.inputs.push_back(job.input);
  }
  write_file(folder_ / name / "job.sh", script_of(jobs));
  write_array(name);  // before Slurm has it, so that none is ever forgotten
  std::string command = fmt::format(
      "sbatch --parsable --job-name={} --array=0-{}{} --ntasks=1 --cpus-per-task={} --requeue "
      "--open-mode=append --output={}",
      name, jobs.size() - 1, options_.most > 0 ? fmt::format("%{}", options_.most) : "", options_.threads,
      quoted((folder_ / name / "%a.txt").string()));
  for (const std::string& option : options_.further) command += " " + quoted(option);
  const Answer answer = ask_shell(command + " " + quoted((folder_ / name / "job.sh").string()));
  // "12" or "12;cluster", below any warnings
  const std::string last = answer.text.substr(answer.text.rfind('\n') + 1);
  if (answer.code != 0 || last.empty() || last.find_first_not_of("0123456789") == 0) {
    fs::remove_all(folder_ / name);
    arrays_.erase(name);
    throw InputError(fmt::format("Slurm refused the study:\n{}", answer.text));
  }
  array.job = last.substr(0, last.find(';'));
  write_array(name);
  for (std::size_t k = 0; k < jobs.size(); ++k) {
    tasks_[jobs[k].name] = {{name, static_cast<int>(k)}, jobs[k].input};
    awaited_[jobs[k].name] = std::move(jobs[k]);
  }
  knows_states_ = false;  // what was told before knows nothing of these
  pause_ = first_pause;
  fmt::print("Slurm job {}: {} members submitted\n", array.job, array.members.size());
  std::fflush(stdout);
}

/// How a task ended; nothing while it has not, or while its files cannot be seen yet.
std::optional<Ended> SlurmSite::end_of(const Job& job, Task& task) const {
  const std::string state = state_of(task.place);
  if (is_live(state)) {
    task.state = state;
    return std::nullopt;
  }
  const fs::path file = job.folder / "exit";
  const std::string verdict = verdict_of(state);
  if (fs::exists(file)) {
    Ended ended = ended_with(job, std::atoi(read_file(file).c_str()));
    if (!ended.succeeded && !verdict.empty()) return Ended{job.name, false, false, verdict};
    return ended;
  }
  if (!verdict.empty()) return Ended{job.name, false, false, verdict};
  const bool has_exit = state.empty() || state == "COMPLETED" || state == "FAILED";
  if (!task.gone) task.gone = Clock::now();
  if (has_exit && Clock::now() - *task.gone < patience) return std::nullopt;
  // Of a task that somebody cancels before it begins nothing is left in the list.
  if (state.empty() && task.state == "PENDING") return Ended{job.name, false, false, verdict_of("CANCELLED")};
  return Ended{job.name, false, true,
               state.empty() ? "Slurm lost it" : fmt::format("Slurm ended it: {}", state)};
}

std::vector<Ended> SlurmSite::ended() {
  std::vector<Ended> all;
  if (Clock::now() - asked_ < pause_) return all;
  const std::string complaint = ask();
  if (!complaint.empty()) {
    // It may be down for a while; its tasks go on.
    if (!is_silent_) fmt::print(stderr, "Slurm does not answer, waiting for it\n{}\n", complaint);
    is_silent_ = true;
    return all;
  }
  is_silent_ = false;
  for (auto run = awaited_.begin(); run != awaited_.end();) {
    auto end = end_of(run->second, tasks_.at(run->first));
    if (!end) {
      ++run;
      continue;
    }
    forget(run->first);
    all.push_back(std::move(*end));
    run = awaited_.erase(run);
  }
  return all;
}

int SlurmSite::running() const {
  return static_cast<int>(std::ranges::count_if(
      awaited_, [&](const auto& member) { return state_of(tasks_.at(member.first).place) == "RUNNING"; }));
}

std::string SlurmSite::leave() {
  std::set<std::string> jobs;
  for (const auto& [name, job] : awaited_) jobs.insert(arrays_.at(tasks_.at(name).place.first).job);
  if (jobs.empty()) return "";
  return fmt::format("{} members go on in Slurm (scancel {} stops them); ", awaited_.size(),
                     fmt::join(jobs, " "));
}

std::vector<std::string> SlurmSite::jobs_alive(const fs::path& folder) {
  if (!fs::exists(folder) || !has_program("squeue")) return {};
  const SlurmSite site(folder, {});
  std::set<std::string> jobs;
  for (const auto& [name, task] : site.tasks_)
    if (is_live(site.state_of(task.place))) jobs.insert(site.arrays_.at(task.place.first).job);
  return {jobs.begin(), jobs.end()};
}

}  // namespace trackbed
