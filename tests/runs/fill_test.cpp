// Stones that a later stage adds find their place between those that are there already.
#include <gtest/gtest.h>

#include <filesystem>

#include "io/files.h"
#include "lab/run.h"
#include "scenes/temporary_folder.h"

namespace trackbed {
namespace {

const char* two_fills = R"(
title = "Two fills"
stones.fidelity = "ball"
stones.material = "stone"
[stones.grading]
sieves = ["20 mm", "40 mm"]
passing = ["0 %", "100 %"]
[materials.stone]
kn = "1e6 N/m"
ks = "1e6 N/m"
friction = 0.5
density = "2630 kg/m^3"
[walls.box]
kind = "box"
size = ["200 mm", "200 mm", "200 mm"]
material = "stone"
[[stages]]
kind = "fill"
name = "first"
porosity = 0.8
[[stages]]
kind = "fill"
name = "second"
porosity = 0.8
)";

TEST(fill, twice_leaves_no_overlap) {
  const TemporaryFolder folder;
  const auto file = folder.path / "case.toml";
  write_file(file, two_fills);
  const Document document(file, {});
  CaseInput experiment;
  document.read(experiment);
  Simulation sim = make_simulation(document, experiment);
  for (const auto& stage : experiment.stages) stage.input->make(experiment)->open(sim);
  ASSERT_GT(sim.state.clumps.size(), 100);
  const Clumps& c = sim.state.clumps;
  double nearest = 1;
  for (std::size_t i = 0; i < c.id.size(); ++i)
    for (std::size_t j = i + 1; j < c.id.size(); ++j)
      nearest = std::min(nearest, (c.position[i] - c.position[j]).norm() -
                                      0.02 * (c.scale[i] + c.scale[j]));  // the template's radius is 20 mm
  EXPECT_GT(nearest, 0);
}

}  // namespace
}  // namespace trackbed
