// The program: each subcommand reads its own command line. Exits 0 when done, 1 for a run that failed, 2 for
// wrong input.
#include <fmt/format.h>
#include <sys/prctl.h>
#include <unistd.h>

#include <array>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <string>
#include <string_view>

#include "base/error.h"
#include "commands.h"
#include "fem/blas.h"

namespace {

struct Command {
  std::string_view name;
  int (*run)(int argc, char** argv);
  std::string_view purpose;
};

constexpr std::array commands = {
    Command{"run", trackbed::run_command, "run a case and write its results"},
    Command{"apss", trackbed::apss_command, "run a case with clumps where they matter, balls elsewhere"},
    Command{"study", trackbed::study_command, "run a case under many conditions and seeds"},
    Command{"judge", trackbed::judge_command,
            "accept or refuse runs by a rule, beside runs of another model"},
    Command{"couple", trackbed::couple_command, "couple a track with the bed under its sleepers"},
    Command{"check", trackbed::check_command,
            "check a case, study, rule or coupling and say what it would do"},
    Command{"describe", trackbed::describe_command, "say what may stand in a case"},
    Command{"bench", trackbed::bench_command, "time this machine on a bed"},
    Command{"stone", trackbed::stone_command, "check stone meshes and fill them with pebbles"},
};

int dispatch(int argc, char** argv) {
  const std::string_view name = argc > 1 ? argv[1] : "";
  for (const Command& command : commands)
    if (command.name == name) return command.run(argc - 1, argv + 1);
  const bool asked = name == "--help" || name == "-h";
  fmt::print(asked ? stdout : stderr, "usage: trackbed COMMAND ...   (COMMAND --help says more)\n");
  for (const Command& command : commands)
    fmt::print(asked ? stdout : stderr, "  {:8} {}\n", command.name, command.purpose);
  return asked ? 0 : 2;
}

/// What libraries read once, when they are loaded: a second start, with what suits this machine.
void tune_libraries(char** argv) {
  if (std::getenv("OMP_WAIT_POLICY") || std::getenv("GOMP_SPINCOUNT")) return;
  // Threads wait for each other several times a step. On a machine shared with other work, long spinning
  // keeps the cores from whoever has work: with one of two cores taken a small bed on two threads makes three
  // times as many steps as with 20000, with both idle as many within what runs differ by.
  ::setenv("GOMP_SPINCOUNT", "1000", 1);
  // Large pages, where the system leaves the choice to the program: a bed is tens of megabytes. What is freed
  // stays with the program: each time that the pairs are made anew it wants as much again, in zeros, which
  // took 3 to 12 % of the time in which 584,000 balls part.
  ::setenv(
      "GLIBC_TUNABLES",
      "glibc.malloc.hugetlb=1:glibc.malloc.trim_threshold=1000000000:glibc.malloc.mmap_threshold=33554432",
      0);
  if (const std::string kernels = trackbed::fem::blas_kernels_to_ask_for(); !kernels.empty())
    ::setenv("OPENBLAS_CORETYPE", kernels.c_str(), 0);
  ::execv("/proc/self/exe", argv);  // returns only when it fails; then all goes on as it is
}

}  // namespace

int main(int argc, char** argv) {
  tune_libraries(argv);
  ::prctl(PR_SET_NAME, "trackbed");  // else "exe" to top and pkill: it was started by that path
  try {
    return dispatch(argc, argv);
  } catch (const trackbed::InputError& error) {
    fmt::print(stderr, "trackbed: {}\n", error.what());
    return 2;
  } catch (const std::exception& error) {
    fmt::print(stderr, "trackbed: {}\n", error.what());
    return 1;
  }
}
