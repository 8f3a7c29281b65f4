#include "lab/bench_scenes.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <map>
#include <set>

#include "io/files.h"
#include "lab/case.h"
#include "lab/kept_bed.h"
#include "lab/measures/measures.h"
#include "scenes/temporary_folder.h"

namespace trackbed {
namespace {

namespace fs = std::filesystem;

class BenchScenes : public ::testing::Test {
 protected:
  BenchBeds beds() {
    return {folder_, [this](const std::string& stage) { told_.push_back(stage); }};
  }

  TemporaryFolder temporary_;
  fs::path folder_ = temporary_.path;
  std::vector<std::string> told_;
};

/// One ball in the scene's box.
void keep_one_ball(const BenchScene& scene, const fs::path& file) {
  std::vector<std::string> overrides = scene.overrides;
  overrides.emplace_back("stones.fidelity=ball");
  const Document document = Document::from_text(scene.text, scene.name, overrides);
  CaseInput input;
  document.read(input);
  Simulation sim = make_simulation(document, input);
  add_clump(sim.model, sim.state, 0, 1, 0, {{0, 0, 0.02}, Quat::Identity()});
  write_kept_bed(sim, file);
}

TEST_F(BenchScenes, AreAllMadeOfCasesThatCanBeRun) {
  std::set<std::string> names;
  for (const BenchScene& scene : bench_scenes()) {
    EXPECT_TRUE(names.insert(scene.name).second) << scene.name;
    keep_one_ball(scene, kept_bed(scene, folder_));
    BenchRun run = start_bench(scene, beds());
    EXPECT_EQ(run.sim.state.clumps.size(), 1) << scene.name;
    for (int k = 0; k < 3; ++k) run.step();
    EXPECT_EQ(run.sim.state.step, 3);
    if (scene.time_step > 0) {
      EXPECT_EQ(run.sim.state.dt, scene.time_step);
      EXPECT_EQ(run.sim.model.pairs(0, 0).kn, 1e7);
    }
  }
  EXPECT_TRUE(told_.empty());
}

/// The same recipe in a small box.
void shrink(BenchScene& scene) {
  scene.overrides.emplace_back("walls.box.size=[\"0.15 m\", \"0.15 m\", \"0.2 m\"]");
  scene.overrides.emplace_back("walls.lid.point=[\"0 m\", \"0 m\", \"0.12 m\"]");
  scene.overrides.emplace_back("stages.scatter.porosity=0.6");
}

TEST_F(BenchScenes, SettleABedOnceAndKeepIt) {
  BenchScene scene = find_bench_scene("w1");
  shrink(scene);
  scene.overrides.emplace_back("materials.stone.kn=1e6 N/m");
  BenchRun made = start_bench(scene, beds());
  EXPECT_EQ(told_, (std::vector<std::string>{"shapes", "scatter", "replace", "calm", "remove", "rest"}));
  EXPECT_GT(made.sim.state.clumps.size(), 10);
  told_.clear();
  const BenchRun read = start_bench(scene, beds());
  EXPECT_TRUE(told_.empty());
  EXPECT_EQ(hash(read.sim.state), hash(made.sim.state));
  // Shear forces are not kept: the bed finds them again within a few steps.
  for (int k = 0; k < 3 * scene.warm; ++k) made.step();
  EXPECT_LT(unbalanced_ratio(made.sim.model, made.sim.state), 0.01);
}

TEST_F(BenchScenes, FinerStonesTakeOverASettledBed) {
  BenchScene coarse = find_bench_scene("w2b");
  shrink(coarse);
  coarse.overrides.emplace_back("materials.stone.kn=1e6 N/m");
  coarse.overrides.emplace_back("stones.distance=145 deg");
  coarse.overrides.emplace_back("stones.ratio=0.4");
  BenchScene fine = coarse;
  fine.bed = "fine";
  fine.overrides.emplace_back("stones.distance=155 deg");
  fine.settled_as = std::make_shared<const BenchScene>(coarse);
  const BenchRun a = start_bench(coarse, beds());
  told_.clear();
  const BenchRun b = start_bench(fine, beds());
  EXPECT_EQ(told_, (std::vector<std::string>{"shapes", "rest"}));
  EXPECT_GT(b.sim.model.templates[0].pebbles.size(), 1.5 * a.sim.model.templates[0].pebbles.size());
  const auto places = [](const Clumps& c) {
    std::map<int, Vec3> at;
    for (std::size_t k = 0; k < c.id.size(); ++k) at[c.id[k]] = c.position[k];
    return at;
  };
  const auto before = places(a.sim.state.clumps), after = places(b.sim.state.clumps);
  ASSERT_EQ(after.size(), before.size());
  // Finer corners push the stones apart a little; one or two on top may roll over, but none is thrown.
  constexpr double stone = 0.05;  // [m], about its size
  double sum = 0;
  for (const auto& [id, place] : before) {
    const double way = (after.at(id) - place).norm();
    EXPECT_LT(way, stone) << id;
    sum += way;
  }
  EXPECT_LT(sum / static_cast<double>(before.size()), 0.2 * stone);
}

TEST_F(BenchScenes, AnotherRecipeIsAnotherBed) {
  const BenchScene w1 = find_bench_scene("w1");
  EXPECT_NE(kept_bed(w1, folder_), kept_bed(find_bench_scene("balls-500k"), folder_));
  BenchScene other = w1;
  other.overrides.emplace_back("seed=2");
  EXPECT_NE(kept_bed(w1, folder_), kept_bed(other, folder_));
}

}  // namespace
}  // namespace trackbed
