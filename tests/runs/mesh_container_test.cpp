// A closed mesh as the container: a trough with sloping sides.
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>

#include "io/files.h"
#include "lab/measures/measures.h"
#include "lab/room.h"
#include "lab/run.h"
#include "scenes/temporary_folder.h"

namespace trackbed {
namespace {

// 160 x 160 mm at the bottom, 280 x 160 mm at the top, 150 mm high.
constexpr const char* trough = R"(v -80 -80 0
v 80 -80 0
v 80 80 0
v -80 80 0
v -140 -80 150
v 140 -80 150
v 140 80 150
v -140 80 150
f 1 3 2
f 1 4 3
f 5 6 7
f 5 7 8
f 1 2 6
f 1 6 5
f 2 3 7
f 2 7 6
f 3 4 8
f 3 8 7
f 4 1 5
f 4 5 8
)";

constexpr const char* filled_trough = R"toml(
title = "Stones in a trough"
seed = 2
[stones]
shapes = 3
distance = "110 deg"
ratio = 0.5
[stones.grading]
sieves = ["20 mm", "30 mm"]
passing = ["0 %", "100 %"]
[stones.sets.stand_in]
fidelity = "stand_in"
[materials.ballast]
kn = "1e6 N/m"
ks = "1e6 N/m"
friction = 0.5
density = "2630 kg/m^3"
[walls.trough]
kind = "mesh"
file = "trough.obj"
unit = "1 mm"
container = true
material = "ballast"
[[stages]]
kind = "scatter"
set = "stand_in"
porosity = 0.5
[[stages]]
kind = "replace"
[[stages]]
kind = "settle"
)toml";

TEST(mesh_container, is_filled_by_its_volume_and_bears_the_stones) {
  const TemporaryFolder folder;
  write_file(folder.path / "trough.obj", trough);
  write_file(folder.path / "case.toml", filled_trough);
  const Document document(folder.path / "case.toml", {});
  CaseInput experiment;
  document.read(experiment);
  Simulation sim = make_simulation(document, experiment);
  const double volume = 0.5 * (0.16 + 0.28) * 0.16 * 0.15;
  EXPECT_NEAR(volume_in(sim.container, [&](const Vec3& x) { return is_in_room(sim, x); }) / volume, 1, 0.01);

  std::vector<NamedStage> stages = stages_of(experiment);
  for (NamedStage& named : stages) carry_out(sim, *named.stage);
  EXPECT_NEAR(solid_volume(sim) / (0.5 * volume), 1, 0.03);  // a stone is 1 %
  for (const Vec3& x : sim.state.clumps.position) EXPECT_TRUE(is_in_room(sim, x)) << x.transpose();
  EXPECT_NEAR(-sim.state.walls[0].force.z() / weight(sim), 1, 1e-2);
  EXPECT_LT(sim.state.walls[0].force.head<2>().norm(), 2e-2 * weight(sim));
  const double pores = porosity(sim, pebble_volume(sim));  // the loose bed has come down
  EXPECT_GT(pores, 0.3);
  EXPECT_LT(pores, 0.6);
}

TEST(mesh_container, must_be_closed) {
  const TemporaryFolder folder;
  const std::string open(trough);
  write_file(folder.path / "trough.obj", open.substr(0, open.rfind("f 3 4 8")));
  write_file(folder.path / "case.toml", filled_trough);
  const Document document(folder.path / "case.toml", {});
  CaseInput experiment;
  document.read(experiment);
  EXPECT_THROW(make_simulation(document, experiment), std::exception);
}

}  // namespace
}  // namespace trackbed
