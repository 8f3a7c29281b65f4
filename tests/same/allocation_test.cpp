// A step allocates nothing: memory is asked for when candidates are looked for, and kept.
#include <gtest/gtest.h>
#include <omp.h>

#include <atomic>
#include <cstdlib>
#include <new>

#include "base/rng.h"
#include "scenes/scene.h"

// Sanitizers have allocators of their own.
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
#define TRACKBED_OTHER_ALLOCATOR
#elif defined(__has_feature)
#if __has_feature(address_sanitizer) || __has_feature(thread_sanitizer)
#define TRACKBED_OTHER_ALLOCATOR
#endif
#endif
#ifndef TRACKBED_OTHER_ALLOCATOR

namespace {

std::atomic<long> allocations{0};

void* take(std::size_t size, std::size_t alignment) {
  ++allocations;
  const std::size_t whole = (size + alignment - 1) / alignment * alignment;
  if (void* memory = std::aligned_alloc(alignment, whole == 0 ? alignment : whole)) return memory;
  throw std::bad_alloc();
}

}  // namespace

void* operator new(std::size_t size) {
  return take(size, __STDCPP_DEFAULT_NEW_ALIGNMENT__);
}
void* operator new(std::size_t size, const std::nothrow_t&) noexcept {
  try {
    return operator new(size);
  } catch (const std::bad_alloc&) {
    return nullptr;
  }
}
void* operator new(std::size_t size, std::align_val_t alignment) {
  return take(size, static_cast<std::size_t>(alignment));
}
void operator delete(void* memory) noexcept {
  std::free(memory);
}
void operator delete(void* memory, std::size_t) noexcept {
  std::free(memory);
}
void operator delete(void* memory, std::align_val_t) noexcept {
  std::free(memory);
}
void operator delete(void* memory, std::size_t, std::align_val_t) noexcept {
  std::free(memory);
}

namespace trackbed {
namespace {

/// Stones of four pebbles on a plate of triangles, between planes.
Simulation bed() {
  scenes::Setting a;
  a.friction = 0.5;
  a.rolling_friction = 0.2;
  a.law = LawKind::linear_rolling;
  a.damping = 0.7;
  a.gravity = {0, 0, -9.81};
  Simulation sim = scenes::make_scene(a);
  sim.model.templates.push_back(make_clump_template(
      "lump",
      {{{0, 0, 0}, 0.018}, {{0.012, 0, 0}, 0.014}, {{-0.01, 0.006, 0}, 0.013}, {{0, -0.01, 0.008}, 0.012}},
      3e-5, {4e-9, 5e-9, 6e-9}));
  Rng rng(5, "bed");
  scenes::add_plate(sim, scenes::plate(-0.2, 0.2, -0.2, 0.2, 0, 4, 4));
  for (const Vec3& side : {Vec3(1, 0, 0), Vec3(-1, 0, 0), Vec3(0, 1, 0), Vec3(0, -1, 0)})
    scenes::add_plane(sim, -0.12 * side, side);
  for (int k = 0; k < 24; ++k)
    add_clump(
        sim.model, sim.state, 1, 1, 0,
        {Vec3(-0.09 + 0.06 * (k % 4), -0.09 + 0.06 * (k / 4 % 4), 0.04 + 0.065 * (k / 16)), rng.rotation()});
  return sim;
}

TEST(allocation, a_step_of_a_bed_at_rest_makes_none) {
  const int before = omp_get_max_threads();
  omp_set_num_threads(1);
  Simulation sim = bed();
  const long start = allocations;
  const auto is_at_rest = [&] {
    return sim.work.touching > 20 && unbalanced_ratio(sim.model, sim.state) < 1e-4;
  };
  scenes::run_until(sim, 5, is_at_rest);
  EXPECT_GT(allocations - start, 100);  // it is counted: the lists grew while the stones fell
  ASSERT_TRUE(is_at_rest());
  for (int threads : {1, 2}) {
    omp_set_num_threads(threads);
    sim.changed();  // pairs and candidates are found for these places
    for (int k = 0; k < 500; ++k) sim.step();
    const long settled = allocations;
    for (int k = 0; k < 500; ++k) sim.step();
    EXPECT_EQ(allocations - settled, 0) << threads << " threads";
  }
  omp_set_num_threads(before);
}

}  // namespace
}  // namespace trackbed

#endif
