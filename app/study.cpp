// trackbed study: one case under many conditions and seeds, several runs at a time.
#include <fmt/format.h>
#include <sys/file.h>
#include <unistd.h>

#include <fcntl.h>
#include <algorithm>
#include <chrono>
#include <cmath>
#include <csignal>
#include <deque>
#include <map>
#include <memory>
#include <set>
#include <thread>

#include "base/error.h"
#include "command_line.h"
#include "commands.h"
#include "io/files.h"
#include "io/progress.h"
#include "lab/study/fits.h"
#include "lab/study/foreseen.h"
#include "lab/study/results.h"
#include "local_site.h"
#include "slurm_site.h"

namespace trackbed {
namespace {

namespace fs = std::filesystem;
using Clock = std::chrono::steady_clock;

volatile std::sig_atomic_t stop_asked = 0;

struct StudyOptions {
  fs::path file, out;
  std::string until, on = "here";
  std::vector<std::string> sbatch;
  int jobs = 0, threads = 1, most_repeats = 20;
  bool retry = false;
};

/// "sleeper.settlement < 5 %": seeds are added until the interval is that narrow.
struct Goal {
  std::string measure;
  double width = 0;  // half of the 95 % interval over the mean
};

Goal goal_of(const std::string& text) {
  const std::size_t sign = text.find('<');
  Goal goal;
  if (sign != std::string::npos) {
    goal.measure = text.substr(0, sign);
    goal.measure.erase(goal.measure.find_last_not_of(' ') + 1);
    try {
      std::size_t end = 0;
      const std::string number = text.substr(sign + 1);
      goal.width = std::stod(number, &end);
      if (number.find('%', end) != std::string::npos) goal.width /= 100;
    } catch (const std::exception&) {
      goal.width = 0;
    }
  }
  if (goal.measure.empty() || !(goal.width > 0))
    throw InputError(fmt::format(
        "--repeat-until \"{}\": give a measure and the width of its interval, \"push.force_peak < 5 %\"",
        text));
  return goal;
}

/// Keeps a second study out of the folder while this one lives, or a process that it started and that has not
/// noticed yet that it is gone.
class Lock {
 public:
  explicit Lock(const fs::path& folder) : file_(::open((folder / ".lock").c_str(), O_CREAT | O_RDWR, 0644)) {
    if (file_ < 0) throw InputError(fmt::format("{}: cannot be written", folder.string()));
    for (int tries = 0; ::flock(file_, LOCK_EX | LOCK_NB) != 0; ++tries) {
      if (tries == 50)
        throw InputError(fmt::format("{}: another study is at work in this folder", folder.string()));
      std::this_thread::sleep_for(std::chrono::milliseconds(100));
    }
  }
  ~Lock() { ::close(file_); }
  Lock(const Lock&) = delete;
  Lock& operator=(const Lock&) = delete;

 private:
  int file_;
};

class StudyRun {
 public:
  StudyRun(const StudyOptions& options, const Document& document, StudyInput study, Site& site)
      : o_(options), study_(std::move(study)), conditions_(conditions_of(document, study_)), site_(site) {
    if (!o_.until.empty()) goal_ = goal_of(o_.until);
    for (Member& member : members_of(study_, conditions_)) add(std::move(member));
    check_measures(document);
    for (std::size_t c = 0; goal_ && c < conditions_.size(); ++c) add_repeats(c);
  }

  /// Runs what is not done; returns whether all members succeeded.
  bool run() {
    tell_beginning();
    write_tables();
    while (!stop_asked && open() > 0) {
      site_.start(waiting_);
      for (const Ended& ended : site_.ended()) take(ended);
      tell_progress();
      std::this_thread::sleep_for(std::chrono::milliseconds(50));
    }
    const std::string left = site_.leave();
    write_tables();
    return tell_end(left);
  }

 private:
  void check_measures(const Document& document) const {
    const ForeseenMeasures foreseen(study_, conditions_);
    trackbed::check_measures(document, study_, foreseen);
    if (!goal_) return;
    if (!has_chance(study_))
      throw InputError("--repeat-until: nothing in a track case is drawn by chance, one run tells all");
    if (const auto hint = foreseen.hint_for(goal_->measure))
      throw InputError(fmt::format("--repeat-until: no run leaves a measure called {}\n  hint: {}",
                                   goal_->measure, *hint));
  }

  fs::path folder_of(const Member& member) const { return fs::absolute(o_.out) / "members" / member.name; }

  Job job_of(const Member& member) const {
    Job job{member.name, folder_of(member), {}, fingerprint(member)};
    job.arguments = {"run",       fs::absolute(study_.base).string(), "--out",   job.folder.string(),
                     "--threads", std::to_string(o_.threads),         "--quiet", "--resume"};
    for (const std::string& change : member.set) job.arguments.insert(job.arguments.end(), {"--set", change});
    return job;
  }

  void add(Member member) {
    Outcome outcome = outcome_of(member, folder_of(member));
    if (outcome.status == MemberStatus::failed && o_.retry) outcome = {};
    if (outcome.status == MemberStatus::waiting) waiting_.push_back(job_of(member));
    index_[member.name] = members_.size();
    members_.push_back(std::move(member));
    outcomes_.push_back(std::move(outcome));
  }

  /// Members that have not ended.
  std::ptrdiff_t open() const {
    return std::ranges::count(outcomes_, MemberStatus::waiting, &Outcome::status);
  }

  void tell_beginning() const {
    const auto count = [&](MemberStatus status) {
      return std::ranges::count(outcomes_, status, &Outcome::status);
    };
    fmt::print("{}: {} conditions, {} members: {} done, {} failed, {} to run\n", study_.title,
               conditions_.size(), members_.size(), count(MemberStatus::done), count(MemberStatus::failed),
               waiting_.size());
    std::map<std::string, int> changes;
    for (const Outcome& outcome : outcomes_)
      if (outcome.status == MemberStatus::waiting && !outcome.cause.empty()) ++changes[outcome.cause];
    for (const auto& [change, n] : changes) fmt::print("  {} of them run again: {}\n", n, change);
    std::fflush(stdout);
  }

  void take(const Ended& ended) {
    const std::size_t m = index_.at(ended.name);
    Outcome& outcome = outcomes_[m];
    if (ended.succeeded) {
      outcome = outcome_of(members_[m], folder_of(members_[m]));
      if (outcome.status != MemberStatus::done)
        outcome = {MemberStatus::failed,
                   outcome.cause.empty() ? "it left no summary.json"
                                         : "its case was changed while the study ran (" + outcome.cause +
                                               "); --retry runs it again",
                   {}};
      ++finished_;
    } else if (ended.was_stopped && ++stopped_[m] < most_stops) {
      waiting_.push_back(job_of(members_[m]));  // by somebody or for want of memory: not its own fault
      return;
    } else if (!stop_asked) {
      outcome = {MemberStatus::failed, ended.cause, {}};
    }
    if (outcome.status == MemberStatus::failed) {
      write_failure(members_[m], outcome.cause, folder_of(members_[m]));
      fmt::print("{}: {}\n", members_[m].name, outcome.cause);
      std::fflush(stdout);
    }
    if (goal_) add_repeats(members_[m].condition);
    write_tables();
  }

  /// More seeds for a condition all of whose members have ended, until one is to be run (others may have
  /// been, by an earlier call) or its interval is narrow enough.
  void add_repeats(std::size_t condition) {
    while (const auto next = seed_to_add(condition)) add(make_member(study_, conditions_, condition, *next));
  }

  std::optional<std::uint64_t> seed_to_add(std::size_t condition) const {
    int repeats = 0;
    std::uint64_t last = 0;
    for (std::size_t m = 0; m < members_.size(); ++m) {
      if (members_[m].condition != condition) continue;
      if (outcomes_[m].status == MemberStatus::waiting) return std::nullopt;
      last = std::max(last, members_[m].seed);
      ++repeats;
    }
    const Estimate e = estimate_of(goal_->measure, condition, members_, outcomes_);
    if (repeats >= o_.most_repeats || e.relative_width() < goal_->width) return std::nullopt;
    return last + 1;
  }

  void write_tables() const {
    write_members(study_, conditions_, members_, outcomes_, o_.out / "study.csv");
    write_table(study_, conditions_, members_, outcomes_, o_.out / "table.csv");
    write_fits(study_, conditions_, members_, outcomes_, o_.out / "fits.csv");
  }

  void tell_progress() {
    const auto now = Clock::now();
    const bool terminal = ::isatty(STDERR_FILENO) != 0;
    if (now - told_ < std::chrono::seconds(terminal ? 1 : 30)) return;
    told_ = now;
    const double seconds = std::chrono::duration<double>(now - start_).count();
    const double left = static_cast<double>(open()) - 0.5 * site_.running();
    const std::string eta = finished_ > 0 ? duration_text(seconds / finished_ * left) + " left"
                                          : std::string("no member has ended yet");
    fmt::print(stderr, "{}{} of {} members, {} running, {}{}", terminal ? "\r" : "",
               static_cast<std::ptrdiff_t>(members_.size()) - open(), members_.size(), site_.running(), eta,
               terminal ? "   " : "\n");
  }

  bool tell_end(const std::string& left) const {
    const auto failed = std::ranges::count(outcomes_, MemberStatus::failed, &Outcome::status);
    if (stop_asked) {
      fmt::print("stopped: {}the same command goes on from here\n", left);
      return false;
    }
    if (failed > 0) fmt::print("{} members failed; --retry runs them again\n", failed);
    fmt::print("results: {} and table.csv\n", (o_.out / "study.csv").string());
    return failed == 0;
  }

  StudyOptions o_;
  StudyInput study_;
  std::vector<Condition> conditions_;
  std::vector<Member> members_;
  std::vector<Outcome> outcomes_;             // beside the members
  std::map<std::string, std::size_t> index_;  // of a member by its name
  Site& site_;
  std::deque<Job> waiting_;
  static constexpr int most_stops = 3;
  std::map<std::size_t, int> stopped_;  // how often a signal ended a member
  std::optional<Goal> goal_;
  int finished_ = 0;
  Clock::time_point start_ = Clock::now(), told_ = start_;
};

/// The case's seed and what conditions change are not for --set to change.
void add_changes(const std::vector<std::string>& changes, const Document& document, StudyInput& study) {
  std::set<std::string> taken{"seed"};
  for (const Condition& condition : conditions_of(document, study))
    for (const auto& [key, value] : condition.inputs) taken.insert(key);
  for (const std::string& change : changes) {
    const std::string key = change.substr(0, change.find('='));
    if (taken.contains(key))
      throw InputError(fmt::format("--set {}: the study itself changes {}", change, key));
    study.set.push_back(change);
  }
}

std::unique_ptr<Site> make_site(const StudyOptions& o) {
  const fs::path folder = o.out / "slurm";
  if (o.on == "slurm") return std::make_unique<SlurmSite>(folder, SlurmOptions{o.threads, o.jobs, o.sbatch});
  const std::vector<std::string> alive = SlurmSite::jobs_alive(folder);
  if (!alive.empty())
    throw InputError(fmt::format("members of this study run in Slurm: go on with --on slurm, or scancel {}",
                                 fmt::join(alive, " ")));
  const int cores = std::max(1, static_cast<int>(std::thread::hardware_concurrency()));
  const int jobs = o.jobs > 0 ? o.jobs : std::max(1, cores / o.threads);
  if (jobs * o.threads > cores)
    fmt::print(stderr, "{} runs of {} threads on {} cores wait for each other\n", jobs, o.threads, cores);
  return std::make_unique<LocalSite>(jobs);
}

}  // namespace

int study_command(int argc, char** argv) {
  StudyOptions o;
  std::optional<int> repeats;
  std::vector<std::string> changes;
  CLI::App app("Runs a case under many conditions and seeds. Called again, it goes on where it stood.",
               "trackbed study");
  app.add_option("study", o.file, "the study file (TOML)")->required();
  app.add_option("--out", o.out, "folder of the results; default: out/NAME of the study's folder");
  app.add_option("--set", changes, "change a value of the case in all members, as in trackbed run")
      ->type_name("KEY=VALUE")
      ->allow_extra_args(false);
  app.add_option("--repeats", repeats, "seeds of each condition, instead of the study's")
      ->check(CLI::Range(1, 100000));
  app.add_option("--jobs", o.jobs, "runs at a time; by default as many as there are cores for their threads")
      ->check(CLI::Range(1, 4096));
  app.add_option("--threads", o.threads, "threads of each run")
      ->check(CLI::Range(1, 4096))
      ->capture_default_str();
  app.add_option("--on", o.on, "here: on this machine; slurm: as a job array of the Slurm that is there")
      ->check(CLI::IsMember({"here", "slurm"}))
      ->capture_default_str();
  app.add_option("--sbatch", o.sbatch,
                 "with --on slurm, an option of sbatch: --sbatch=--partition=short --sbatch=--time=2:00:00 "
                 "--sbatch=--mem=2G")
      ->type_name("OPTION")
      ->allow_extra_args(false);
  CLI::Option* until = app.add_option("--repeat-until", o.until,
                                      "add seeds until the 95 % interval is so narrow: \"MEASURE < 5 %\"");
  app.add_option("--most-repeats", o.most_repeats, "seeds of a condition that --repeat-until stops at")
      ->check(CLI::Range(2, 100000))
      ->needs(until)
      ->capture_default_str();
  app.add_flag("--retry", o.retry, "run members again that failed");
  if (const auto code = parse(app, argc, argv)) return *code;
  if (!o.sbatch.empty() && o.on != "slurm") throw InputError("--sbatch is for --on slurm only");
  if (o.out.empty()) o.out = default_out(o.file);

  const Document document(o.file);
  StudyInput study;
  document.read(study);
  study.base = fs::absolute(study.base);  // as members are called with it: their inputs name files from there
  add_changes(changes, document, study);
  if (repeats) study.repeats = *repeats;
  make_folder(o.out);
  const Lock lock(o.out);
  const std::unique_ptr<Site> site = make_site(o);
  for (int signal : {SIGINT, SIGTERM}) std::signal(signal, [](int) { stop_asked = 1; });
  return StudyRun(o, document, std::move(study), *site).run() ? 0 : 1;
}

}  // namespace trackbed
