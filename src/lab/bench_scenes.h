// The scenes on which speed is measured, the same for ever, so that figures of different days compare.
#pragma once

#include <filesystem>
#include <functional>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "lab/simulation.h"
#include "lab/stage.h"

namespace trackbed {

/// An experiment (lab/case.h) whose last stage is timed. What the stages before it leave is kept in a file.
struct BenchScene {
  std::string name;
  std::string about;                   // what it is, in a line
  std::string text;                    // the case
  std::vector<std::string> overrides;  // of its values
  std::string bed;                     // scenes with the same name here start from the same kept bed
  std::shared_ptr<const BenchScene> settled_as;  // whose bed finer stones of the same shapes take over
  double side = 0;       // of the square floor, for beds that come in a file of spheres [m]
  double time_step = 0;  // [s]; 0: automatic
  int warm = 600;        // steps before timing: contacts find their shear forces again
  int steps = 0;         // of a timed block; 0: about a second
};

const std::vector<BenchScene>& bench_scenes();

/// Throws InputError with the scenes there are, the nearest name first.
const BenchScene& find_bench_scene(std::string_view name);

/// A scene about to be timed: each step is run.step().
struct BenchRun {
  Simulation sim;
  std::unique_ptr<Stage> load;  // what acts on it; nothing for a bed from a file

  void step() {
    if (load) load->control(sim);
    sim.step();
  }
};

/// Where settled beds are kept, and who is told which stage of making one has begun.
struct BenchBeds {
  std::filesystem::path folder;
  std::function<void(const std::string& stage)> tell;
};

/// The file in which the bed of a scene is kept: its name changes with the recipe.
std::filesystem::path kept_bed(const BenchScene& scene, const std::filesystem::path& folder);

/// Makes the bed if none is kept, reads it and makes the last stage ready.
BenchRun start_bench(const BenchScene& scene, const BenchBeds& beds);

}  // namespace trackbed
