#include "lab/shown.h"

#include <gtest/gtest.h>

#include <algorithm>

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

// A frame of 22,000 balls took 4 GB of memory and 432 MB on the disk, one of as many clumps 339 MB.
TEST(Shown, ManyStonesAreCoarse) {
  const Simulation sim = scenes::make_scene({});
  const auto facets = [&](int stones) { return shown_surfaces(sim.model, stones).at(0).facets.size(); };
  EXPECT_EQ(facets(1000), 1280u);
  EXPECT_EQ(facets(22'000), 80u);
  EXPECT_EQ(facets(500'000), 20u);
}

TEST(Shown, ManyStonesWithShapesKeepTheirForm) {
  Simulation sim = scenes::make_scene({});
  ClumpTemplate& t = sim.model.templates[0];
  t.surface = icosphere(4, 1.0);  // 5120 facets
  t.bounding_radius = 1;
  for (const int stones : {1000, 22'000}) {
    const TriangleMesh shown = shown_surfaces(sim.model, stones).at(0);
    const double wanted = std::min(1280.0, 5e6 / stones);
    EXPECT_LT(static_cast<double>(shown.facets.size()), 2 * wanted) << stones;
    EXPECT_GT(static_cast<double>(shown.facets.size()), wanted / 2) << stones;
    EXPECT_NEAR(mass_properties(shown).volume / mass_properties(t.surface).volume, 1, 0.12) << stones;
  }
}

}  // namespace
}  // namespace trackbed
