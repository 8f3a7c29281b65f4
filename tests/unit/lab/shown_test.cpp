#include "lab/shown.h"

#include <gtest/gtest.h>

#include "geom/mass_properties.h"
#include "geom/primitives.h"
#include "scenes/scene.h"

namespace trackbed {
namespace {

TEST(Shown, FineMeshesBecomeCoarseAndKeepTheirForm) {
  const TriangleMesh ball = icosphere(5, 1.0);  // 20480 facets
  const TriangleMesh coarse = merge_vertices(ball, 1.0 / 8);
  EXPECT_LT(coarse.facets.size(), 3000u);
  EXPECT_NEAR(mass_properties(coarse).volume / mass_properties(ball).volume, 1.0, 0.02);
}

TEST(Shown, AStoneWithoutMeshShowsItsPebbles) {
  Simulation sim = scenes::make_scene({});
  const std::vector<TriangleMesh> shown = shown_surfaces(sim.model, 1);
  ASSERT_EQ(shown.size(), 1u);
  EXPECT_NEAR(mass_properties(shown[0]).volume / sim.model.templates[0].volume, 1.0, 0.02);
}

// A frame of 22,000 balls took 4 GB of memory and 432 MB on the disk.
TEST(Shown, ManyBallsAreCoarse) {
  const Simulation sim = scenes::make_scene({});
  const auto facets = [&](int stones) { return shown_surfaces(sim.model, stones).at(0).facets.size(); };
  EXPECT_EQ(facets(1000), 1280u);
  EXPECT_EQ(facets(22'000), 80u);
  EXPECT_EQ(facets(500'000), 20u);
}

}  // namespace
}  // namespace trackbed
