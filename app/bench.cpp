// trackbed bench: the speed of this machine on a bed.
#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <vector>

#include "command_line.h"
#include "commands.h"
#include "dem/threads.h"
#include "lab/bed_file.h"

namespace trackbed {
namespace {

struct BenchOptions {
  std::filesystem::path bed;
  double side = 0.6;  // [m]
  double dt = 8e-6;   // [s]
  int threads = 1, blocks = 7, steps = 0, warm = 300;
  double skin = 0;  // [m]
};

double seconds_of(Simulation& sim, int steps) {
  const auto start = std::chrono::steady_clock::now();
  for (int k = 0; k < steps; ++k) sim.step();
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

}  // namespace

int bench_command(int argc, char** argv) {
  BenchOptions o;
  CLI::App app("Times steps on a settled bed: linear law, friction 0.5, local damping 0.7.",
               "trackbed bench");
  app.add_option("--bed", o.bed, "lines x y z r [clump], SI")->required()->check(CLI::ExistingFile);
  app.add_option("--side", o.side, "of the square floor [m]")->check(CLI::PositiveNumber);
  app.add_option("--dt", o.dt, "time step [s]")->check(CLI::PositiveNumber);
  app.add_option("--threads", o.threads, "number of threads")->check(CLI::Range(1, 4096));
  app.add_option("--blocks", o.blocks, "timed blocks")->check(CLI::Range(1, 1000));
  app.add_option("--steps", o.steps, "steps of a block; 0: about a second")->check(CLI::NonNegativeNumber);
  app.add_option("--skin", o.skin, "search distance [m]; 0: automatic")->check(CLI::NonNegativeNumber);
  if (const auto code = parse(app, argc, argv)) return *code;

  use_threads(o.threads);
  Simulation sim = read_bed(o.bed, o.side, 2630);
  sim.model.local_damping = 0.7;
  sim.model.time_step.fixed = o.dt;
  sim.model.search.skin = o.skin;
  sim.number_by_place();
  const double warm = seconds_of(sim, o.warm);
  const int steps = o.steps > 0 ? o.steps : std::max(10, static_cast<int>(o.warm / warm));
  const Profile before = sim.work.profile;
  std::vector<double> rates;
  for (int b = 0; b < o.blocks; ++b) rates.push_back(steps / seconds_of(sim, steps));
  std::sort(rates.begin(), rates.end());

  const Profile& p = sim.work.profile;
  const double search = p.search - before.search, forces = p.forces - before.forces,
               gather = p.gather - before.gather, motion = p.motion - before.motion;
  const double all = search + forces + gather + motion;
  std::size_t candidates = 0;
  for (const PairBlock& block : sim.state.pair_blocks) candidates += block.keys.size();
  for (const WallBlock& block : sim.state.wall_blocks) candidates += block.keys.size();
  fmt::print(
      "{} stones, {} threads: {:.1f} steps/s ({:.1f} - {:.1f}), {} contacts, {} candidates, "
      "search {:.0f} %, forces {:.0f} %, gather {:.0f} %, motion {:.0f} %, hash {:016x}\n",
      sim.state.clumps.size(), o.threads, rates[rates.size() / 2], rates.front(), rates.back(),
      sim.work.touching, candidates, 100 * search / all, 100 * forces / all, 100 * gather / all,
      100 * motion / all, hash(sim.state));
  return 0;
}

}  // namespace trackbed
