#include "geom/stone_generator.h"

#include <gtest/gtest.h>

#include "base/error.h"
#include "geom/mass_properties.h"
#include "geom/shape.h"
#include "geom/solid.h"

namespace trackbed {
namespace {

struct Means {
  double elongation = 0, flatness = 0, sphericity = 0, convexity = 0;
};

/// Each stone is a solid as it comes, in its ranges and of its sieve size.
Means means_of(const StoneRecipe& recipe, int count) {
  Means means;
  for (int k = 0; k < count; ++k) {
    SCOPED_TRACE(k);
    const TriangleMesh mesh = generate_stone(recipe, 1, k);
    EXPECT_TRUE(make_solid(mesh, "made").repairs.empty());
    EXPECT_LT(mass_properties(mesh).centre.norm(), 1e-9);
    const Shape shape = measure_shape(mesh);
    EXPECT_NEAR(shape.sieve_size, recipe.sieve_size, 0.005 * recipe.sieve_size);
    EXPECT_LE(shape.length / shape.thickness, recipe.largest_l_over_s * 1.005);
    EXPECT_GE(shape.elongation, recipe.elongation.low * 0.97);
    EXPECT_LE(shape.elongation, recipe.elongation.high * 1.03);
    means.elongation += shape.elongation / count;
    means.flatness += shape.flatness / count;
    means.sphericity += shape.sphericity / count;
    means.convexity += shape.convexity / count;
  }
  return means;
}

TEST(stone_generator, stones_are_like_scanned_rubble) {
  const Means means = means_of({}, 50);
  EXPECT_NEAR(means.elongation, 0.71, 0.03);
  EXPECT_NEAR(means.flatness, 0.59, 0.03);
  EXPECT_NEAR(means.sphericity, 0.767, 0.025);
  EXPECT_NEAR(means.convexity, 0.874, 0.02);
}

TEST(stone_generator, convex_stones) {
  StoneRecipe recipe = convex_recipe();
  recipe.sieve_size = 0.04;
  const Means means = means_of(recipe, 50);
  EXPECT_NEAR(means.convexity, 1, 1e-9);
  EXPECT_NEAR(means.sphericity, 0.80, 0.05);
}

TEST(stone_generator, same_seed_and_index_same_stone) {
  const TriangleMesh a = generate_stone({}, 7, 3), b = generate_stone({}, 7, 3);
  EXPECT_EQ(a.vertices, b.vertices);
  EXPECT_NE(a.vertices, generate_stone({}, 7, 4).vertices);
  EXPECT_NE(a.vertices, generate_stone({}, 8, 3).vertices);
}

TEST(stone_generator, refuses_recipes_that_cannot_be_met) {
  StoneRecipe recipe;
  recipe.largest_l_over_s = 1.2;
  EXPECT_THROW(generate_stone(recipe, 1, 0), InputError);
  recipe = {};
  recipe.faces = {2, 40};
  EXPECT_THROW(generate_stone(recipe, 1, 0), InputError);
  recipe = {};
  recipe.sieve_size = 0;
  EXPECT_THROW(generate_stone(recipe, 1, 0), InputError);
}

}  // namespace
}  // namespace trackbed
