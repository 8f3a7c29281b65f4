// A run that went wrong stops within a hundred steps and says which stone, where and when.
#include <gtest/gtest.h>

#include <functional>
#include <limits>
#include <string>

#include "base/error.h"
#include "scenes/scene.h"

namespace trackbed {
namespace {

std::string complaint(Simulation& sim) {
  try {
    for (int k = 0; k < 100; ++k) sim.step();
  } catch (const RunError& error) {
    return error.what();
  }
  return "";
}

Simulation three_balls() {
  scenes::Setting a;
  a.gravity = {0, 0, -9.81};
  Simulation sim = scenes::make_scene(a);
  scenes::add_plane(sim, Vec3::Zero(), Vec3::UnitZ());
  for (int k = 0; k < 3; ++k) scenes::add_ball(sim, {0.1 * k, 0, 0.03});
  for (int k = 0; k < 30; ++k) sim.step();
  return sim;
}

bool has(const std::string& text, const char* part) {
  return text.find(part) != std::string::npos;
}

TEST(failure, number_that_is_none) {
  for (int what = 0; what < 3; ++what) {
    Simulation sim = three_balls();
    Clumps& c = sim.state.clumps;
    (what == 0   ? c.position
     : what == 1 ? c.velocity
                 : c.force)[1]
        .x() = std::numeric_limits<double>::quiet_NaN();
    const std::string text = complaint(sim);
    EXPECT_TRUE(has(text, "stone 1 at (") && has(text, "step ") && has(text, "not a number")) << text;
  }
}

// Making the pairs of stones with a place that is not a number never came to an end.
TEST(failure, search_with_a_number_that_is_none_ends) {
  Simulation sim = three_balls();
  sim.state.clumps.position[1].x() = std::numeric_limits<double>::quiet_NaN();
  sim.work = {};
  EXPECT_TRUE(has(complaint(sim), "stone 1 at ("));
}

TEST(failure, too_fast) {
  Simulation sim = three_balls();
  set_motion(sim.state, 2, {0, 150, 0}, Vec3::Zero());
  const std::string text = complaint(sim);
  EXPECT_TRUE(has(text, "stone 2 at (") && has(text, "150 m/s") && has(text, "100 m/s")) << text;
}

TEST(failure, outside_the_domain) {
  Simulation sim = three_balls();
  sim.model.domain = Eigen::AlignedBox3d(Vec3(-0.05, -1, 0), Vec3(0.15, 1, 1));
  const std::string text = complaint(sim);
  EXPECT_TRUE(has(text, "stone 2 at (0.2") && has(text, "left the container")) << text;
}

TEST(failure, overlap_too_large) {
  Simulation sim = three_balls();
  sim.state.clumps.position[1] = sim.state.clumps.position[0] + Vec3(0.03, 0, 0);
  const std::string text = complaint(sim);
  EXPECT_TRUE(has(text, "stone 0 at (") && has(text, "overlaps stone 1") && has(text, "50 %")) << text;
}

TEST(failure, step_chosen_too_long) {
  Simulation sim = three_balls();
  sim.model.time_step.fixed = 5e-3;
  const std::string text = complaint(sim);
  EXPECT_TRUE(has(text, "time step 0.005 s is above the stable one") && has(text, "stone ")) << text;
}

}  // namespace
}  // namespace trackbed
