// Stones are the same however many threads make them, and in whatever order.
#include <gtest/gtest.h>

#include <array>
#include <future>

#include "base/hash.h"
#include "geom/stone.h"
#include "geom/stone_generator.h"

namespace trackbed {
namespace {

std::uint64_t fingerprint(int index) {
  StoneRecipe recipe;
  recipe.sieve_size = 0.04;
  ClumpFilling filling;
  filling.ratio = 0.5;
  const Stone stone = make_stone(generate_stone(recipe, 7, index), "stone", filling);
  Hash hash;
  for (const Vec3& v : stone.clump.surface.vertices)
    for (int a = 0; a < 3; ++a) hash.add(v[a]);
  for (const Pebble& p : stone.clump.pebbles) hash.add(p.radius);
  for (double number : {stone.clump.volume, stone.clump.sieve_size, stone.shape.convexity}) hash.add(number);
  return hash.value();
}

TEST(stones, do_not_depend_on_threads_or_order) {
  constexpr std::size_t n = 4;
  std::array<std::uint64_t, n> alone;
  for (std::size_t k = n; k-- > 0;) alone[k] = fingerprint(static_cast<int>(k));
  std::array<std::future<std::uint64_t>, n> together;
  for (std::size_t k = 0; k < n; ++k)
    together[k] = std::async(std::launch::async, fingerprint, static_cast<int>(k));
  for (std::size_t k = 0; k < n; ++k) EXPECT_EQ(together[k].get(), alone[k]) << "stone " << k;
}

}  // namespace
}  // namespace trackbed
