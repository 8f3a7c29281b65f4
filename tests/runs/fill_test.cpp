// Stones that a later stage adds find their place between those that are there already; those it replaces
// count with those that were replaced before.
#include <gtest/gtest.h>

#include <algorithm>
#include <string>

#include "lab/run.h"

namespace trackbed {
namespace {

const std::string box = R"(
title = "Two stages that fill"
stones.fidelity = "ball"
stones.material = "stone"
[stones.grading]
sieves = ["20 mm", "40 mm"]
passing = ["0 %", "100 %"]
[stones.sets.heavy]
fidelity = "ball"
material = "heavy"
[materials.stone]
kn = "1e6 N/m"
ks = "1e6 N/m"
friction = 0.5
density = "2630 kg/m^3"
[materials.heavy]
kn = "1e6 N/m"
ks = "1e6 N/m"
friction = 0.5
density = "3500 kg/m^3"
[walls.box]
kind = "box"
size = ["200 mm", "200 mm", "200 mm"]
material = "stone"
)";

/// Stones that are scattered part below it.
const std::string lid = R"(
[walls.lid]
kind = "plane"
point = ["0 mm", "0 mm", "200 mm"]
normal = [0, 0, -1]
material = "stone"
)";

/// Two stages of a kind.
std::string twice(const std::string& kind) {
  std::string stages;
  for (const char* name : {"first", "second"})
    stages += "[[stages]]\nkind = \"" + kind + "\"\nname = \"" + name + "\"\nporosity = 0.8\n";
  return stages;
}

struct Filled {
  Simulation sim;
  std::vector<Result> found;  // by the last stage

  explicit Filled(const std::string& stages) {
    const Document document = Document::from_text(box + stages, "case.toml", {});
    CaseInput experiment;
    document.read(experiment);
    sim = make_simulation(document, experiment);
    for (NamedStage& named : stages_of(experiment)) found = carry_out(sim, *named.stage);
  }
  /// Least distance of two centres, less that at which the stones just touch [m].
  double least_gap() const {
    const Clumps& c = sim.state.clumps;
    double least = 1;
    for (std::size_t i = 0; i < c.id.size(); ++i)
      for (std::size_t j = i + 1; j < c.id.size(); ++j)
        least = std::min(least, (c.position[i] - c.position[j]).norm() -
                                    0.02 * (c.scale[i] + c.scale[j]));  // the template's radius is 20 mm
    return least;
  }
};

TEST(fill, twice_leaves_no_overlap) {
  const Filled bed(twice("fill"));
  ASSERT_GT(bed.sim.state.clumps.size(), 100);
  EXPECT_GT(bed.least_gap(), 0);
}

// Had both the same random numbers, stones of the second would lie in those of the first.
TEST(scatter, twice_has_other_places_the_second_time) {
  const Filled bed(lid + twice("scatter"));
  ASSERT_GT(bed.sim.state.clumps.size(), 100);
  EXPECT_GT(bed.least_gap(), -0.005);
}

TEST(replace, counts_stones_that_are_of_the_set_already) {
  const Filled bed(lid + R"(
[[stages]]
kind = "scatter"
porosity = 0.6
[[stages]]
kind = "replace"
name = "some"
set = "heavy"
share = 0.3
[[stages]]
kind = "replace"
name = "more"
set = "heavy"
share = 0.5
)");
  const Clumps& c = bed.sim.state.clumps;
  double heavy = 0, all = 0;
  for (std::size_t k = 0; k < c.id.size(); ++k) {
    all += c.mass[k];
    if (c.material[k] == bed.sim.find_material("heavy")) heavy += c.mass[k];
  }
  EXPECT_NEAR(heavy / all, 0.5, 0.5 * *std::ranges::max_element(c.mass) / all);
  const auto share = std::ranges::find(bed.found, "mass_share", &Result::name);
  ASSERT_NE(share, bed.found.end());
  EXPECT_NEAR(share->value, heavy / all, 1e-9);
}

}  // namespace
}  // namespace trackbed
