// What a wall that moves reports.
#include <gtest/gtest.h>

#include <cmath>

#include "lab/case.h"
#include "lab/run.h"
#include "scenes/scene.h"

namespace trackbed {
namespace {

std::unique_ptr<Stage> stage_of(const std::string& text) {
  const Document document = Document::from_text(text, "case.toml", {});
  CaseInput input;
  document.read(input);
  return input.stages.at(0).input->make(input);
}

double value_of(const std::vector<Result>& results, const std::string& name) {
  for (const Result& r : results)
    if (r.name == name) return r.value;
  ADD_FAILURE() << "there is no result " << name;
  return 0;
}

// A ball between two planes is a spring of 0.5e6 N/m: mean force over the way from a to b k (a + b)/2.
TEST(Move, MeansOfTheForceOverPartsOfTheWay) {
  scenes::Setting setting;
  setting.damping = 0.7;
  Simulation sim = scenes::make_scene(setting);
  scenes::add_plane(sim, Vec3::Zero(), Vec3::UnitZ());
  const int lid = scenes::add_plane(sim, {0, 0, 0.04}, -Vec3::UnitZ());
  sim.model.walls[static_cast<std::size_t>(lid)].shape.name = "lid";
  scenes::add_ball(sim, {0, 0, 0.02});
  sim.changed();
  const auto results = carry_out(sim, *stage_of(R"toml(
title = "Press"
[materials.ballast]
kn = "1e7 N/m"
ks = "1e7 N/m"
[[stages]]
kind = "move"
wall = "lid"
velocity = ["0 m/s", "0 m/s", "-10 mm/s"]
distance = "0.45 mm"
mean_over = "0.1 mm"
)toml"));
  const double peak = value_of(results, "force_peak");
  EXPECT_NEAR(peak, 225, 2);
  EXPECT_NEAR(value_of(results, "mean_force_peak"), 0.5e6 * 0.35e-3, 2);  // the last half part is not whole
  EXPECT_NEAR(value_of(results, "distance_at_mean_peak"), 0.35e-3, 1e-12);
}

}  // namespace
}  // namespace trackbed
