// Lattices of balls, whose stiffness and frequencies are known.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <numbers>
#include <vector>

#include "dem/touching.h"
#include "scenes/scene.h"

namespace trackbed {
namespace {

using scenes::Setting;

constexpr double distance = 0.02;  // of touching centres [m]

/// One ball of a lattice and the neighbours it touches, all carried by one small uniform strain.
struct Cell {
  std::vector<Vec3> neighbours;
  double volume;  // of the lattice, per ball [m^3]
};

Cell simple_cubic() {
  Cell cell{{}, std::pow(distance, 3)};
  for (int axis = 0; axis < 3; ++axis)
    for (double side : {-1.0, 1.0}) cell.neighbours.push_back(side * distance * Vec3::Unit(axis));
  return cell;
}

Cell face_centred_cubic() {
  Cell cell{{}, std::pow(distance, 3) / std::numbers::sqrt2};
  for (int axis = 0; axis < 3; ++axis)
    for (double s : {-1.0, 1.0})
      for (double t : {-1.0, 1.0})
        cell.neighbours.push_back(distance / std::numbers::sqrt2 *
                                  (s * Vec3::Unit((axis + 1) % 3) + t * Vec3::Unit((axis + 2) % 3)));
  return cell;
}

/// Change of the mean stress (tension positive) when the lattice takes the strain `strain` from a slightly
/// pressed state, by the virial of the middle ball's contacts: sum of force x branch over twice the volume.
Mat3 stress_of(const Cell& cell, const Mat3& strain, double ks) {
  Setting a;
  a.radius = 0.5 * distance;
  a.ks = ks;
  a.friction = 1e6;
  a.density = 1e12;  // the balls go where they are sent
  a.dt = 1e-3;
  Simulation sim = scenes::make_scene(a);
  constexpr double pressed = 1e-5;
  scenes::add_ball(sim, Vec3::Zero());
  for (const Vec3& x : cell.neighbours) scenes::add_ball(sim, (1 - pressed) * x);
  sim.changed();
  const auto virial = [&] {
    Mat3 sum = Mat3::Zero();
    visit_touching(sim.model, sim.state, [&](const Touching& t) {
      if (t.clump_1 != 0) return;
      const Vec3 branch = sim.state.clumps.position[static_cast<std::size_t>(t.clump_2)];
      sum -= t.force() * branch.transpose();
    });
    return Mat3(sum / (2 * cell.volume));
  };
  const Mat3 before = virial();
  for (std::size_t k = 0; k < cell.neighbours.size(); ++k)
    sim.state.clumps.velocity[k + 1] = strain * sim.state.clumps.position[k + 1] / a.dt;
  sim.step();
  return virial() - before;
}

/// C11, C12 and C44.
std::array<double, 3> stiffness(const Cell& cell, double ks) {
  constexpr double e = 1e-7;
  Mat3 stretch = Mat3::Zero(), shear = Mat3::Zero();
  stretch(0, 0) = e;
  shear(0, 1) = shear(1, 0) = 0.5 * e;
  const Mat3 stretched = stress_of(cell, stretch, ks), sheared = stress_of(cell, shear, ks);
  return {stretched(0, 0) / e, stretched(1, 1) / e, 0.5 * (sheared(0, 1) + sheared(1, 0)) / e};
}

// V-21 and V-22. The lattice is pressed by 1e-3, so that no contact opens; that alone changes the branches by
// 1e-3.
TEST(lattice, stiffness_of_simple_and_face_centred_cubic) {
  constexpr double kn = 1e6;
  for (const double ks : {1e6, 5e5, 1e-6}) {
    const std::array<double, 3> cubic{kn / distance, 0, ks / (2 * distance)};
    const double unit = std::numbers::sqrt2 / distance;
    const std::array<double, 3> centred{unit * (kn + ks), 0.5 * unit * (kn - ks), 0.5 * unit * (kn + ks)};
    const auto sc = stiffness(simple_cubic(), ks), fcc = stiffness(face_centred_cubic(), ks);
    for (std::size_t k = 0; k < 3; ++k) {
      EXPECT_NEAR(sc[k], cubic[k], 1e-4 * cubic[0]) << ks << " " << k;
      EXPECT_NEAR(fcc[k], centred[k], 1e-4 * centred[0]) << ks << " " << k;
    }
  }
}

/// A chain of n balls between two walls, each contact pressed by 1 um.
Simulation make_chain(int n, double dt) {
  constexpr double pressed = 1e-6;
  Setting a;
  a.dt = dt;
  Simulation sim = scenes::make_scene(a);
  sim.model.time_step.safety = 100;  // the limit itself is what is looked for
  sim.model.limits.overlap = 1e9;
  sim.model.limits.speed = 1e9;
  scenes::add_plane(sim, Vec3::Zero(), Vec3::UnitX());
  for (int k = 0; k < n; ++k) scenes::add_ball(sim, {0.02 - pressed + k * (0.04 - pressed), 0, 0});
  scenes::add_plane(sim, {0.04 * n - (n + 1) * pressed, 0, 0}, -Vec3::UnitX());
  return sim;
}

double frequency(int n, int mode) {
  return 2 * std::sqrt(1e6 / 0.0888023523) * std::sin(mode * std::numbers::pi / (2 * (n + 1)));
}

// V-24.
TEST(lattice, chain_swings_in_its_modes) {
  EXPECT_NEAR(frequency(10, 1), 955.142, 1e-3);
  EXPECT_NEAR(frequency(10, 10), 6643.159, 1e-3);
  for (const auto& [n, mode] : {std::pair{10, 1}, {10, 2}, {10, 10}, {2, 1}, {2, 2}}) {
    const double unit = scenes::contact_time_scale({});
    const double dt = 0.1 * unit, omega = frequency(n, mode);
    Simulation sim = make_chain(n, dt);
    const auto shape = [&, n = n, mode = mode](int k) {
      return std::sin(mode * (k + 1) * std::numbers::pi / (n + 1));
    };
    for (int k = 0; k < n; ++k) sim.state.clumps.velocity[static_cast<std::size_t>(k)].x() = 1e-4 * shape(k);
    std::vector<double> crossings;
    double last = 0;
    while (crossings.size() < 20) {
      sim.step();
      double now = 0;
      for (int k = 0; k < n; ++k)
        now += shape(k) * sim.state.clumps.velocity[static_cast<std::size_t>(k)].x();
      if (last * now < 0) crossings.push_back(sim.state.time - dt * now / (now - last));
      last = now;
    }
    const double measured =
        std::numbers::pi * static_cast<double>(crossings.size() - 1) / (crossings.back() - crossings.front());
    // Leapfrog itself swings at (2/dt) asin(omega dt/2): 1.7e-3 above omega for the fastest mode at this
    // step.
    EXPECT_NEAR(measured / (2 / dt * std::asin(0.5 * omega * dt)), 1, 2e-4) << n << " " << mode;
    EXPECT_NEAR(measured / omega, 1, 2e-3) << n << " " << mode;
  }
}

TEST(lattice, chain_is_stable_up_to_two_over_its_fastest_frequency) {
  const double limit = 2 / frequency(10, 10);
  EXPECT_NEAR(limit, 3.01061e-4, 1e-9);
  for (const double share : {0.98, 1.02}) {
    Simulation sim = make_chain(10, share * limit);
    for (std::size_t k = 0; k < 10; ++k) sim.state.clumps.velocity[k].x() = (k % 2 ? -1e-9 : 1e-9);
    double largest = 0;
    for (int k = 0; k < 60; ++k) {
      sim.step();
      for (const Vec3& v : sim.state.clumps.velocity) largest = std::max(largest, std::abs(v.x()));
    }
    if (share < 1)
      EXPECT_LT(largest, 1e-7);
    else
      EXPECT_GT(largest, 1e-3);  // by when contacts open, and the chain is one no more
  }
}

}  // namespace
}  // namespace trackbed
