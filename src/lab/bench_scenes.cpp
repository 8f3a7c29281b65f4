#include "lab/bench_scenes.h"

#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <utility>

#include "base/error.h"
#include "base/hash.h"
#include "io/files.h"
#include "io/nearest.h"
#include "lab/checkpoint.h"
#include "lab/cyclic_box_case.h"
#include "lab/kept_bed.h"
#include "lab/run.h"
#include "lab/stages/parting.h"

namespace trackbed {
namespace {

// Stones are scattered, as balls, a little above where they will lie: a column of 4.4 m would fall for long,
// and clumps part slowly. Two pieces of 2e7 N/m make a contact of 1e7 N/m.
constexpr const char* filled_bed = R"toml(
title = "Bed at rest in a box of planes"
[stones]
shapes = 1
material = "stone"
[stones.sets.balls]
fidelity = "stand_in"
material = "stone"
[materials.stone]
kn = "2e7 N/m"
ks = "2e7 N/m"
friction = 0.5
density = "2630 kg/m^3"
[stones.grading]
passing = ["0 %", "100 %"]
[walls.box]
kind = "box"
material = "stone"
[walls.lid]
kind = "plane"
normal = [0, 0, -1]
material = "stone"
[[stages]]
kind = "scatter"
set = "balls"
porosity = 0.5
[[stages]]
kind = "replace"
[[stages]]
kind = "settle"
name = "calm"
scaled_step = true
)toml";

constexpr const char* without_lid = R"toml([[stages]]
kind = "remove"
walls = ["lid"]
[[stages]]
kind = "settle"
name = "rest"
)toml";

constexpr const char* held = R"toml([[stages]]
kind = "hold"
duration = "1e9 s"
)toml";

constexpr const char* one_size = "stones.grading.sieves=[\"45 mm\", \"45.000001 mm\"]";

/// So many stones in a box with a square floor of the given side [m], scattered at the given porosity;
/// `volume`: of all [m^3].
BenchScene plain(const std::string& name, const std::string& about, double side, double porosity,
                 double volume, const std::vector<std::string>& stones) {
  const double height = volume / (1 - porosity) / (side * side);
  BenchScene scene;
  scene.name = scene.bed = name;
  scene.about = about;
  scene.text = std::string(filled_bed) + without_lid + held;
  scene.overrides = stones;
  scene.overrides.push_back(fmt::format("stages.scatter.porosity={}", porosity));
  // The sides are higher than the lid: what rises when it is taken away has not left the box. One of half a
  // million balls leapt by a third of the height.
  scene.overrides.push_back(
      fmt::format("walls.box.size=[\"{0} m\", \"{0} m\", \"{1} m\"]", side, 2 * height));
  scene.overrides.push_back(fmt::format("walls.lid.point=[\"0 m\", \"0 m\", \"{} m\"]", height));
  scene.side = side;
  scene.time_step = 8e-6;
  return scene;
}

BenchScene cyclic_box(const std::string& name, const std::string& pebbles,
                      const std::vector<std::string>& stones) {
  BenchScene scene;
  scene.name = scene.bed = name;
  scene.about = fmt::format("cyclic box under its load, {} a stone", pebbles);
  scene.text = cyclic_box_case;
  scene.overrides = stones;
  scene.warm = 2000;
  scene.steps = 2000;
  return scene;
}

/// With so many pebbles a bed would take long to settle.
BenchScene in_the_bed_of(const BenchScene& settled, BenchScene scene) {
  scene.settled_as = std::make_shared<const BenchScene>(settled);
  scene.about += fmt::format(", in the bed of {} come to rest anew", settled.name);
  return scene;
}

std::vector<std::string> filled(std::string_view distance, double ratio) {
  return {fmt::format("stones.distance={} deg", distance), fmt::format("stones.ratio={}", ratio)};
}

std::vector<BenchScene> make_scenes() {
  const std::vector<std::string> balls{"stones.fidelity=ball",
                                       "stones.grading.sieves=[\"22 mm\", \"62 mm\"]"};
  // 20,000 balls of this grading are 0.9518 m^3, a stone of 45 mm 4.771e-5 m^3. Balls part quickly in a dense
  // bed, clumps do not.
  const auto volume = [](int n) { return n / 20000.0 * 0.9518; };
  // Half a million would leap when the lid is taken away, and need an hour to come to rest: they keep it.
  const auto under_a_lid = [&](const std::string& name, const std::string& about, int n, double side) {
    BenchScene scene = plain(name, about, side, 0.415, volume(n), balls);
    scene.text = std::string(filled_bed) + held;
    scene.overrides.emplace_back("stages.calm.unbalanced_ratio=0.005");
    return scene;
  };
  const auto n_clumps = [](const std::string& name, const std::string& about, int n, double side,
                           std::string_view distance, double ratio) {
    std::vector<std::string> all = filled(distance, ratio);
    all.emplace_back(one_size);
    return plain(name, about, side, 0.5, n * 4.771e-5, all);
  };
  const BenchScene box_270 = cyclic_box("box-270", "about 270 pebbles", filled("154", 0.3));
  return {plain("w1", "20,000 balls, radius 11 to 31 mm, in a box of 0.6 m", 0.6, 0.4, volume(20000), balls),
          n_clumps("w2", "2,000 clumps of 20 pebbles, 45 mm, in a box of 0.6 m", 2000, 0.6, "100", 0.35),
          n_clumps("w2b", "500 clumps of 250 pebbles, 45 mm, in a box of 0.3 m", 500, 0.3, "157", 0.3),
          n_clumps("section", "24,000 clumps of 26 pebbles, 45 mm, 0.45 m deep", 24000, 2.08, "115", 0.35),
          under_a_lid("balls-100k", "100,000 balls as in w1, 1.1 m deep under a lid", 100000, 2.685),
          under_a_lid("balls-500k", "500,000 balls as in w1, 1.1 m deep under a lid", 500000, 6.004),
          cyclic_box("box-1", "1 pebble", {"stones.fidelity=ball"}),
          cyclic_box("box-20", "20 pebbles", filled("105", 0.4)),
          cyclic_box("box-70", "about 70 pebbles", filled("128", 0.3)),
          box_270,
          in_the_bed_of(box_270, cyclic_box("box-1000", "about 1,000 pebbles", filled("167.5", 0.3))),
          in_the_bed_of(box_270, cyclic_box("box-5000", "about 5,000 pebbles", filled("174", 0.3)))};
}

/// The experiment of a scene, with and without its stones' shapes, which may take minutes to fill.
struct Experiment {
  Simulation sim;
  std::vector<NamedStage> stages;
};

Experiment experiment_of(const BenchScene& scene, bool with_shapes) {
  std::vector<std::string> overrides = scene.overrides;
  if (!with_shapes) overrides.emplace_back("stones.fidelity=ball");
  const Document document = Document::from_text(scene.text, scene.name, overrides);
  CaseInput input;
  document.read(input);
  return {make_simulation(document, input), stages_of(input)};
}

void run_stage(NamedStage& named, Simulation& sim, const BenchBeds& beds) {
  beds.tell(named.name);
  carry_out(sim, *named.stage);
}

/// Finer stones have corners that lie in their neighbours.
void part(Simulation& sim) {
  const Conditions before = sim.model;
  Parting parting;
  parting.open(sim, 0.1);
  while (!parting.is_done(sim, 0.005, 10)) {
    parting.control(sim);
    sim.step();
  }
  sim.restore(before);
}

void need_bed(const BenchScene& scene, const BenchBeds& beds);

/// The stones of the other scene are replaced by finer ones; then the stage that brought them to rest last is
/// run once more. The frame of a shape is that of its mesh, whatever fills it, so that poses carry over.
void take_over_bed(const BenchScene& scene, Experiment& experiment, const BenchBeds& beds) {
  need_bed(*scene.settled_as, beds);
  Simulation& sim = experiment.sim;
  const std::vector<ClumpTemplate> shapes = sim.model.templates;
  read_kept_bed(kept_bed(*scene.settled_as, beds.folder), sim);
  if (sim.model.templates.size() != shapes.size())
    throw RunError(scene.name + ": the bed it takes over has other shapes");
  sim.model.templates = shapes;
  sim.state.pair_blocks.clear();  // contacts of pebbles that are no more
  sim.state.wall_blocks.clear();
  sim.model.domain.setEmpty();  // stones lie above the rim of the box
  sim.changed();
  part(sim);
  run_stage(experiment.stages[experiment.stages.size() - 2], sim, beds);
}

/// Makes the bed of a scene unless it is kept.
void need_bed(const BenchScene& scene, const BenchBeds& beds) {
  const std::filesystem::path file = kept_bed(scene, beds.folder);
  if (std::filesystem::exists(file)) return;
  make_folder(beds.folder);
  beds.tell("shapes");
  Experiment experiment = experiment_of(scene, true);
  if (scene.settled_as)
    take_over_bed(scene, experiment, beds);
  else
    for (std::size_t k = 0; k + 1 < experiment.stages.size(); ++k)
      run_stage(experiment.stages[k], experiment.sim, beds);
  write_kept_bed(experiment.sim, file);
}

}  // namespace

const std::vector<BenchScene>& bench_scenes() {
  static const std::vector<BenchScene> scenes = make_scenes();
  return scenes;
}

const BenchScene& find_bench_scene(std::string_view name) {
  const std::vector<BenchScene>& all = bench_scenes();
  const auto found = std::ranges::find(all, name, &BenchScene::name);
  if (found != all.end()) return *found;
  std::vector<std::string> known;
  for (const BenchScene& scene : all) known.push_back(scene.name);
  throw InputError(
      fmt::format("there is no bench scene called {}: {}", name, known_words(std::string(name), known)));
}

std::filesystem::path kept_bed(const BenchScene& scene, const std::filesystem::path& folder) {
  Hash recipe;
  recipe.add(state_format);
  recipe.add(std::string_view(scene.text));
  for (const std::string& value : scene.overrides) recipe.add(std::string_view(value));
  if (scene.settled_as) recipe.add(std::string_view(kept_bed(*scene.settled_as, "").string()));
  return folder / fmt::format("{}-{:016x}.bed", scene.bed, recipe.value());
}

BenchRun start_bench(const BenchScene& scene, const BenchBeds& beds) {
  need_bed(scene, beds);
  auto [sim, stages] = experiment_of(scene, false);
  read_kept_bed(kept_bed(scene, beds.folder), sim);
  sim.model.domain.setEmpty();
  if (scene.time_step > 0) sim.model.time_step.fixed = scene.time_step;
  sim.number_by_place();
  stages.back().stage->open(sim);
  return {std::move(sim), std::move(stages.back().stage)};
}

}  // namespace trackbed
