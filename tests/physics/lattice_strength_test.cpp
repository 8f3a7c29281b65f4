// V-23. The strength of a face-centred cubic lattice of rough balls under a load along [001].
//
// Theory (C. Thornton, Géotechnique 29 (1979) 441). A ball touches four balls of the layer above, four of the
// layer below, along unit vectors (1/2, 1/2, 1/sqrt2) and their mirror images, and four of its own layer.
// Where the lattice fails, the layers come nearer and spread, so the contacts within a layer carry nothing,
// and the inclined ones slide: each carries N and T = mu N, the friction upwards on the upper ball, in all
// the vertical force (N + T)/sqrt2 and the horizontal forces (N - T)/2 along x and y.
//
// The block has h times two layers of square rows, of w + 1 and of w balls in turn and w at both ends, with
// walls along the rows. A horizontal plane between two layers crosses 4 w^2 contacts, a vertical plane
// between two columns of balls 4 w h, and nothing but the walls bears what they carry:
//   F_top = 4 w^2 (N + T)/sqrt2 on (w d)^2,   F_side = 4 w h (N - T)/2 on w d x h sqrt2 d,
//   sigma_1/sigma_3 = 2 (N + T)/(N - T) = 2 (1 + mu)/(1 - mu),
// the same for any w and h. (Layers of w + 1 balls at the ends would not do: a ball there at a wall has no
// mirror image above, and smooth walls leave it free to roll instead of sliding: 11 to 23 % less.)
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "dem/servo.h"
#include "dem/threads.h"
#include "scenes/scene.h"

namespace trackbed {
namespace {

constexpr int wide = 3, high = 2;                  // w and h: two unit cells each way
constexpr double radius = 0.02;                    // [m]
constexpr double overlap = 1e-5 * radius;          // of the balls at the start [m]: as good as rigid
constexpr double distance = 2 * radius - overlap;  // of touching centres [m]
constexpr double kn = 1e6;                         // of the contact [N/m]
constexpr double side_force = 2 * wide * high * kn * overlap;  // of each side wall [N]

constexpr std::size_t lid = 1, first_side = 2, walls = 6;  // wall 0 is the floor
const std::array<Vec3, walls> inward{Vec3(0, 0, 1),  Vec3(0, 0, -1), Vec3(1, 0, 0),
                                     Vec3(-1, 0, 0), Vec3(0, 1, 0),  Vec3(0, -1, 0)};

/// The block between six smooth planes. Balls that may not turn are given an immense inertia.
Simulation make_block(double mu, bool may_turn) {
  scenes::Setting a;
  a.radius = radius;
  a.kn = a.ks = kn;
  a.friction = mu;
  a.damping = 0.7;
  Simulation sim = scenes::make_scene(a);
  Material smooth = sim.model.materials[0];
  smooth.friction = 0;
  sim.model.materials.push_back(smooth);
  sim.model.pairs = PairTable(sim.model.materials, a.law, a.dashpot);
  const double rise = distance / std::numbers::sqrt2, height = 2 * high * rise;
  for (int layer = 0; layer <= 2 * high; ++layer) {
    const int n = layer % 2 == 0 ? wide : wide + 1;
    for (int i = 0; i < n; ++i)
      for (int j = 0; j < n; ++j)
        scenes::add_ball(sim, {distance * (i - 0.5 * (n - 1)), distance * (j - 0.5 * (n - 1)),
                               layer * rise - 0.5 * height});
  }
  if (!may_turn)
    for (Vec3& inertia : sim.state.clumps.inertia) inertia *= 1e6;
  for (const Vec3& normal : inward) {
    const double half = 0.5 * (normal.z() != 0 ? height : wide * distance);
    const int wall = scenes::add_plane(sim, -(half + radius - overlap) * normal, normal);
    sim.model.walls[static_cast<std::size_t>(wall)].material = 1;
  }
  sim.changed();
  return sim;
}

/// One step with the lid coming down at `speed` [m/s] and the sides pressing with their force.
void press(Simulation& sim, double speed) {
  for (std::size_t side = first_side; side < walls; ++side)
    sim.state.walls[side].velocity =
        inward[side] * servo_speed(sim.model, sim.state, static_cast<int>(side), inward[side], side_force);
  sim.state.walls[lid].velocity.z() = -speed;
  sim.step();
}

double stress_ratio(const Simulation& sim) {
  const double top = wide * distance * wide * distance;
  const double side = wide * distance * high * std::numbers::sqrt2 * distance;
  return sim.state.walls[lid].force.z() / top / (side_force / side);
}

/// Contacts between layers and within them, and the friction that the former mobilise.
struct Contacts {
  int inclined = 0, level = 0;
  double normal = 0, upwards = 0;  // sums over the inclined ones of N and of the friction against sliding [N]

  explicit Contacts(const State& state) {
    for (const PairBlock& block : state.pair_blocks)
      for (const ContactMemory& c : block.memory) {
        if (!c.touches()) continue;
        const double steep = std::abs(c.normal.z());
        ++(steep > 0.5 ? inclined : level);
        if (steep < 0.5) continue;
        normal += kn * c.overlap;
        // Of the ball above, which is body 2 if the normal points up.
        upwards += std::copysign(1.0, c.normal.z()) * c.shear.z() / std::sqrt(1 - steep * steep);
      }
  }
};

struct Compression {
  double at_rest, peak;  // sigma_1/sigma_3 before the lid moves; the highest
  double least_after;    // the lowest in the last quarter of the lid's way
  double side_error;     // largest of the side forces, relative
  Contacts before, after;
};

Compression compress(double mu, double speed, bool may_turn = true) {
  constexpr double way = 40 * overlap;  // of the lid [m]
  Simulation sim = make_block(mu, may_turn);
  for (int k = 0; k < 500; ++k) press(sim, 0);
  const double start = sim.state.time, end = start + way / speed;
  Compression c{stress_ratio(sim), 0, 1e9, 0, Contacts(sim.state), Contacts(sim.state)};
  while (sim.state.time < end) {
    press(sim, speed);
    const double ratio = stress_ratio(sim);
    c.peak = std::max(c.peak, ratio);
    if (sim.state.time > end - 0.25 * (end - start)) c.least_after = std::min(c.least_after, ratio);
    for (std::size_t side = first_side; side < walls; ++side)
      c.side_error = std::max(c.side_error, std::abs(sim.state.walls[side].force.norm() / side_force - 1));
  }
  c.after = Contacts(sim.state);
  return c;
}

double strength(double mu) {
  return 2 * (1 + mu) / (1 - mu);
}

constexpr double slow = 1e-5;  // [m/s]: by one overlap in 67 sqrt(m/k)

/// The load rose to a peak and stayed there: the lattice flows, by sliding between its layers alone.
void expect_failure(const Compression& c, double mu) {
  EXPECT_LT(c.at_rest, 0.5 * c.peak) << mu;
  EXPECT_GT(c.least_after, 0.98 * c.peak) << mu;
  EXPECT_LT(c.side_error, 5e-3) << mu;
  constexpr int all = 2 * high * 4 * wide * wide;
  EXPECT_EQ(c.before.inclined, all) << mu;
  EXPECT_GT(c.before.level, 0) << mu;
  EXPECT_EQ(c.after.inclined, all) << mu;
  EXPECT_EQ(c.after.level, 0) << mu;
}

/// The block is so small that a second thread on a busy machine costs ten times what it gains.
class lattice_strength : public testing::Test {
 protected:
  void SetUp() override { use_threads(1); }
  void TearDown() override { use_threads(0); }
};

// Balls that do not turn, as in the theory, reach it: 0.2 % above, and half of that with half the speed.
TEST_F(lattice_strength, of_balls_that_slide) {
  for (const double mu : {0.3, 0.5}) {
    const Compression c = compress(mu, slow, false);
    expect_failure(c, mu);
    EXPECT_NEAR(c.peak / strength(mu), 1, 5e-3) << mu;
    EXPECT_NEAR(c.after.upwards / c.after.normal / mu, 1, 2e-3) << mu;
  }
}

// Balls that may turn begin to roll as soon as their neighbours in the layer let go: some contacts then
// mobilise less than mu, and the lattice is weaker, by 1.6 % at mu = 0.5 however slow and stiff. Hence 3 %.
TEST_F(lattice_strength, of_free_balls) {
  for (const double mu : {0.3, 0.5}) {
    const Compression c = compress(mu, slow), faster = compress(mu, 2 * slow);
    expect_failure(c, mu);
    EXPECT_NEAR(c.peak / strength(mu), 1, 0.03) << mu;
    EXPECT_NEAR(faster.peak / c.peak, 1, 0.01) << mu;
  }
}

}  // namespace
}  // namespace trackbed
