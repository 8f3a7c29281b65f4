// What stones cost in memory: a template once, a stone little, whatever it is made of.
#include <gtest/gtest.h>
#include <malloc.h>

#include <memory>

#include "base/rng.h"
#include "scenes/scene.h"

namespace trackbed {
namespace {

/// Bytes that are in use on the heap.
double in_use() {
  const struct mallinfo2 heap = mallinfo2();
  return static_cast<double>(heap.uordblks + heap.hblkhd);
}

/// Stones of so many pebbles that are nowhere near each other.
double bytes_of(int stones, int pebbles) {
  const double before = in_use();
  Simulation sim = scenes::make_scene({});
  Rng rng(1, "pebbles");
  std::vector<Pebble> all;
  for (int k = 0; k < pebbles; ++k) all.push_back({0.01 * (rng.rotation() * Vec3::UnitX()), 0.005});
  sim.model.templates.push_back(make_clump_template("lump", all, 1e-5, {1e-9, 1e-9, 1e-9}));
  for (int k = 0; k < stones; ++k)
    add_clump(sim.model, sim.state, 1, 1, 0, {Vec3(k % 20, k / 20 % 20, k / 400), Quat::Identity()});
  sim.changed();
  for (int k = 0; k < 3; ++k) sim.step();
  return in_use() - before;
}

TEST(Memory, AStoneCostsLessThanAKilobyteBesideItsPairsWhateverItIsMadeOf) {
  constexpr int many = 8192, few = 4096;  // vectors that grow by doubling are full
  for (const int pebbles : {1, 20, 500}) {
    const double each = (bytes_of(many, pebbles) - bytes_of(few, pebbles)) / (many - few);
    EXPECT_LT(each, 1000) << pebbles;
    EXPECT_GT(each, 300) << pebbles;  // it was counted
  }
}

TEST(Memory, ATemplateIsThereOnce) {
  // A pebble costs as much with many stones as with few.
  const double few = bytes_of(64, 500) - bytes_of(64, 20), many = bytes_of(4096, 500) - bytes_of(4096, 20);
  EXPECT_LT(few, 480 * 400);
  EXPECT_LT(many - few, 0.5 * few);
}

}  // namespace
}  // namespace trackbed
