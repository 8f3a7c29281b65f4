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
  const std::vector<TriangleMesh> shown = shown_surfaces(sim.model);
  ASSERT_EQ(shown.size(), 1u);
  EXPECT_NEAR(mass_properties(shown[0]).volume / sim.model.templates[0].volume, 1.0, 0.02);
}

}  // namespace
}  // namespace trackbed
