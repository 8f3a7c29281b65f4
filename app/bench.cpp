// trackbed bench: the speed of this machine on scenes that stay the same for ever.
#include <fmt/chrono.h>
#include <fmt/format.h>
#include <malloc.h>
#include <sys/resource.h>

#include <algorithm>
#include <chrono>
#include <cstdlib>
#include <ctime>
#include <fstream>
#include <vector>

#include "base/error.h"
#include "command_line.h"
#include "commands.h"
#include "commit.h"
#include "dem/threads.h"
#include "io/csv.h"
#include "io/files.h"
#include "kept.h"
#include "lab/bed_file.h"
#include "lab/bench_scenes.h"

namespace trackbed {
namespace {

namespace fs = std::filesystem;

struct BenchOptions {
  std::vector<std::string> scenes;
  fs::path bed, csv, keep;
  double side = 0, skin = 0;  // [m]
  int threads = 1, blocks = 7, steps = 0;
  bool list = false;
};

struct BenchResult {
  std::string scene;
  int stones = 0, threads = 0;
  double pebbles = 0;         // mean of a stone
  std::vector<double> rates;  // steps/s of the blocks, ascending
  int contacts = 0;
  std::size_t candidates = 0;
  Profile seconds;         // in the timed steps
  double peak = 0;         // memory while stepping [MB]
  std::uint64_t hash = 0;  // of the state before the first timed step: the same on every machine

  double median() const { return rates[rates.size() / 2]; }
  /// Of the time of all steps [%].
  std::array<double, 4> shares() const {
    const double all = seconds.search + seconds.forces + seconds.gather + seconds.motion;
    return {100 * seconds.search / all, 100 * seconds.forces / all, 100 * seconds.gather / all,
            100 * seconds.motion / all};
  }
};

double seconds_of(BenchRun& run, int steps) {
  const auto start = std::chrono::steady_clock::now();
  for (int k = 0; k < steps; ++k) run.step();
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

double pebbles_per_stone(const Simulation& sim) {
  double pebbles = 0;
  for (int shape : sim.state.clumps.shape)
    pebbles += static_cast<double>(sim.model.templates[static_cast<std::size_t>(shape)].pebbles.size());
  return pebbles / sim.state.clumps.size();
}

std::size_t candidates_of(const State& state) {
  std::size_t candidates = 0;
  for (const PairBlock& block : state.pair_blocks) candidates += block.keys.size();
  for (const WallBlock& block : state.wall_blocks) candidates += block.keys.size();
  return candidates;
}

/// From here on the peak counts what is in use, not what making the scene took (Linux: proc(5), clear_refs).
void forget_peak_memory() {
  ::malloc_trim(0);
  std::ofstream("/proc/self/clear_refs") << 5;
}

double peak_megabytes() {
  rusage usage{};
  ::getrusage(RUSAGE_SELF, &usage);
  return static_cast<double>(usage.ru_maxrss) / 1024;
}

BenchResult time_steps(BenchRun& run, const BenchScene& scene, const BenchOptions& o) {
  BenchResult result;
  forget_peak_memory();
  const double warm = seconds_of(run, scene.warm);
  result.hash = hash(run.sim.state);
  int steps = o.steps > 0 ? o.steps : scene.steps;
  if (steps == 0) steps = std::max(10, static_cast<int>(scene.warm / warm));
  const Profile before = run.sim.work.profile;
  for (int b = 0; b < o.blocks; ++b) result.rates.push_back(steps / seconds_of(run, steps));
  std::sort(result.rates.begin(), result.rates.end());
  const Profile& p = run.sim.work.profile;
  result.seconds = {p.search - before.search, p.forces - before.forces, p.gather - before.gather,
                    p.motion - before.motion};
  result.scene = scene.name;
  result.stones = run.sim.state.clumps.size();
  result.pebbles = pebbles_per_stone(run.sim);
  result.threads = o.threads;
  result.contacts = run.sim.work.touching;
  result.candidates = candidates_of(run.sim.state);
  result.peak = peak_megabytes();
  return result;
}

/// The bed of the file in place of that of the scene.
BenchRun start_from_file(const BenchScene& scene, const fs::path& bed, double side) {
  BenchRun run{read_bed(bed, side, 2630), nullptr};
  run.sim.model.local_damping = 0.7;
  run.sim.model.time_step.fixed = scene.time_step;
  run.sim.number_by_place();
  return run;
}

BenchResult bench(const BenchScene& scene, const BenchOptions& o) {
  BenchRun run;
  if (!o.bed.empty()) {
    use_threads(o.threads);
    run = start_from_file(scene, o.bed, o.side > 0 ? o.side : scene.side);
  } else {
    use_threads(0);  // settling a bed may take all cores
    const fs::path folder = o.keep.empty() ? default_cache() : o.keep;
    if (folder.empty())
      throw InputError(
          "neither XDG_CACHE_HOME nor HOME says where beds can be kept: give a folder with --keep");
    run = start_bench(scene, {folder, [&](const std::string& stage) {
                                fmt::print(stderr, "{}: making a bed, to be kept in {}: {}\n", scene.name,
                                           folder.string(), stage);
                              }});
    use_threads(o.threads);
  }
  run.sim.model.search.skin = o.skin;
  run.sim.changed();
  return time_steps(run, scene, o);
}

void print(const BenchResult& r) {
  const auto shares = r.shares();
  fmt::print(
      "{:10} {} threads  {:.1f} steps/s ({:.1f} - {:.1f}), {} stones of {:.1f} pebbles, {} contacts, "
      "{} candidates, search {:.0f} %, forces {:.0f} %, gather {:.0f} %, motion {:.0f} %, {:.0f} MB, "
      "hash {:016x}\n",
      r.scene, r.threads, r.median(), r.rates.front(), r.rates.back(), r.stones, r.pebbles, r.contacts,
      r.candidates, shares[0], shares[1], shares[2], shares[3], r.peak, r.hash);
  std::fflush(stdout);
}

std::string processor() {
  std::ifstream in("/proc/cpuinfo");
  for (std::string line; std::getline(in, line);)
    if (line.starts_with("model name")) return line.substr(std::min(line.find(": ") + 2, line.size()));
  return "unknown";
}

constexpr std::string_view table_header =
    "date,commit,machine,scene,threads,stones,pebbles a stone,median [steps/s],least [steps/s],"
    "greatest [steps/s],contacts,candidates,search [%],forces [%],gather [%],motion [%],peak [MB],hash";

/// Opens the table, with its header when it is new.
std::ofstream open_table(const fs::path& file) {
  const bool is_new = !fs::exists(file) || fs::file_size(file) == 0;
  std::string header;
  if (!is_new) std::getline(std::ifstream(file), header);
  if (!is_new && header != table_header)
    throw InputError(file.string() + ": has other columns than this table; name a new file");
  std::ofstream out(file, std::ios::app);
  if (is_new) out << table_header << '\n';
  if (!out.flush()) throw InputError(file.string() + ": cannot be written");
  return out;
}

void append(const BenchResult& r, const fs::path& file) {
  std::ofstream out = open_table(file);
  out << fmt::format("{:%F %T},{},{},{},", fmt::localtime(std::time(nullptr)), TRACKBED_COMMIT,
                     csv_field(processor()), csv_field(r.scene));
  out << fmt::format("{},{},{:.1f},{:.2f},{:.2f},{:.2f},{},{},", r.threads, r.stones, r.pebbles, r.median(),
                     r.rates.front(), r.rates.back(), r.contacts, r.candidates);
  const auto shares = r.shares();
  out << fmt::format("{:.1f},{:.1f},{:.1f},{:.1f},{:.0f},{:016x}\n", shares[0], shares[1], shares[2],
                     shares[3], r.peak, r.hash);
  if (!out.flush()) throw RunError(file.string() + ": the row could not be written");
}

void print_scenes() {
  for (const BenchScene& scene : bench_scenes()) fmt::print("{:10}  {}\n", scene.name, scene.about);
  fmt::print(
      "Contacts of 1e7 N/m, friction 0.5, local damping 0.7, time step 8e-6 s; in the cyclic box those of "
      "its\n"
      "case, with the automatic time step. A bed is settled once from the program's own stones and kept. "
      "The\n"
      "boxes have stones of the same sizes and, but for the ball, shapes; each bed is settled for itself "
      "where\n"
      "nothing else is said.\n");
}

/// What is to be timed; refuses what does not go together.
std::vector<BenchScene> chosen_scenes(const BenchOptions& o) {
  std::vector<BenchScene> scenes;
  for (const std::string& name : o.scenes) scenes.push_back(find_bench_scene(name));
  if (o.bed.empty()) {
    if (o.side > 0) throw InputError("--side is the floor of a bed from a file: give it with --bed");
    if (scenes.empty())
      for (const char* name : {"w1", "w2", "w2b"}) scenes.push_back(find_bench_scene(name));
    return scenes;
  }
  if (scenes.size() > 1) throw InputError("--bed replaces the bed of one scene: name one scene, or none");
  if (scenes.empty()) {
    scenes.push_back(find_bench_scene("w1"));  // its physics and floor
    scenes[0].name = o.bed.stem().string();
  }
  if (scenes[0].side == 0)
    throw InputError(
        fmt::format("the scene {} has a sleeper and graded stones: it cannot start from a file of spheres, "
                    "run it without --bed",
                    scenes[0].name));
  return scenes;
}

}  // namespace

int bench_command(int argc, char** argv) {
  BenchOptions o;
  CLI::App app("Times steps of scenes that stay the same; by default w1, w2 and w2b. --list tells them.",
               "trackbed bench");
  app.add_option("SCENE", o.scenes, "scenes to time");
  app.add_flag("--list", o.list, "tell the scenes, time nothing");
  app.add_option("--threads", o.threads, "number of threads")
      ->check(CLI::Range(1, 4096))
      ->capture_default_str();
  app.add_option("--bed", o.bed, "start from this file instead: lines x y z r [clump], SI")
      ->check(CLI::ExistingFile);
  app.add_option("--side", o.side, "of the square floor of that bed [m]; by default the scene's")
      ->check(CLI::PositiveNumber);
  app.add_option("--blocks", o.blocks, "timed blocks")->check(CLI::Range(1, 1000))->capture_default_str();
  app.add_option("--steps", o.steps, "steps of a block; by default the scene's, or about a second")
      ->check(CLI::PositiveNumber);
  app.add_option("--skin", o.skin, "search distance [m]; by default automatic")->check(CLI::PositiveNumber);
  app.add_option("--csv", o.csv, "append a row a scene to this file");
  app.add_option("--keep", o.keep, "folder of settled beds; by default ~/.cache/trackbed");
  if (const auto code = parse(app, argc, argv)) return *code;
  if (o.list) {
    print_scenes();
    return 0;
  }
  const std::vector<BenchScene> scenes = chosen_scenes(o);
  if (!o.csv.empty()) open_table(o.csv);  // better refused now than after the first scene
  for (const BenchScene& scene : scenes) {
    const BenchResult result = bench(scene, o);
    print(result);
    if (!o.csv.empty()) append(result, o.csv);
  }
  return 0;
}

}  // namespace trackbed
