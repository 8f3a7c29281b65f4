// Head-on impacts against their closed forms (Chung & Ooi 2011, linear versions).
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "scenes/scene.h"

namespace trackbed {
namespace {

using scenes::Setting;

TEST(normal_contact, two_balls_exchange_their_speeds) {
  for (const auto& [step, tolerance] : {std::pair{0.1, 1.2e-3}, std::pair{0.02, 1.2e-5 * 4}}) {
    Setting a;
    const double scale = scenes::contact_time_scale(a);
    a.dt = step * scale;
    Simulation sim = scenes::make_scene(a);
    const int left = scenes::add_ball(sim, {-0.0205, 0, 0}, {0.5, 0, 0});
    const int right = scenes::add_ball(sim, {0.0205, 0, 0}, {-0.5, 0, 0});
    double largest = 0;
    scenes::run_until(sim, 5e-3, [&] {
      largest = std::max(largest, 0.04 - (sim.state.clumps.position[1] - sim.state.clumps.position[0]).norm());
      return false;
    });
    const double mass = sim.state.clumps.mass[0];
    EXPECT_NEAR(mass, 0.0888023523, 1e-9);
    EXPECT_NEAR(sim.state.clumps.velocity[static_cast<std::size_t>(left)].x() / -0.5, 1.0, tolerance);
    EXPECT_NEAR(sim.state.clumps.velocity[static_cast<std::size_t>(right)].x() / 0.5, 1.0, tolerance);
    EXPECT_NEAR(largest / std::sqrt(mass / 2e6), 1.0, std::max(1.2e-3, step * step));
    EXPECT_NEAR((sim.state.clumps.velocity[0] + sim.state.clumps.velocity[1]).norm(), 0.0, 1e-12);
  }
}

}  // namespace
}  // namespace trackbed
