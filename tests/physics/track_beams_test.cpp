// Rails and bridges as beams against closed solutions: loads at rest and on the move, masses and sprung
// masses.
#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <cmath>
#include <numbers>
#include <vector>

#include "fem/beam.h"
#include "scenes/track_parts.h"

namespace trackbed::fem {
namespace {

using std::numbers::pi;

constexpr BeamSection rail{2.1e11, 2338e-8, 69.77e-4, 7850};
constexpr double rail_bending = rail.young * rail.second_moment;

/// A long rail on a Winkler foundation with loads on it.
struct RailOnFoundation {
  Beam beam;
  CoupledSystem system;
  Index first = 0;
  std::vector<Index> loads;
  RailOnFoundation(double length, int elements, const BeamSection& section, const Foundation& foundation)
      : beam(section, even_nodes(0, length, elements), BeamEnd::free, BeamEnd::free) {
    first = system.add(std::make_unique<SparsePart>(beam.structure(0, foundation)));
  }
  void load_at(double x, double force) {
    loads.push_back(system.add(Link{GivenForce{force}, beam.at(x, first, 1), 0}));
  }
  double sinks_at(double x) const {
    double w = 0;
    for (const LinkEnd& end : beam.at(x, first, -1)) w += end.weight * system.displacements()(end.port);
    return w;
  }
};

TEST(TrackBeams, AxlesOnAFoundationSinkAsZimmermannSays) {
  const double k = 60e6, lambda = std::pow(k / (4 * rail_bending), 0.25), load = 93e3;
  RailOnFoundation track(30, 200, rail, {k, 0});
  const std::vector<double> axles{12, 14.5};
  for (double x : axles) track.load_at(x, load);
  track.system.find_rest();
  const auto shape = [&](double x) {
    const double s = lambda * std::abs(x);
    return load * lambda / (2 * k) * std::exp(-s) * (std::cos(s) + std::sin(s));
  };
  for (double x = 8; x < 20; x += 0.37)
    EXPECT_NEAR(track.sinks_at(x), shape(x - axles[0]) + shape(x - axles[1]), 1e-4 * shape(0)) << x;
}

/// Force of each support under a load on the middle one, the rail on equal springs s apart. Between supports
/// the rail is an exact beam element, so three-support equations of w and slope hold; solved here in full.
std::vector<double> spring_forces(int supports, double spacing, double spring, double load) {
  const int n = 2 * supports;
  Eigen::MatrixXd k = Eigen::MatrixXd::Zero(n, n);
  const double a = rail_bending / (spacing * spacing * spacing);
  Eigen::Matrix4d e;
  const double s = spacing;
  e << 12, 6 * s, -12, 6 * s, 6 * s, 4 * s * s, -6 * s, 2 * s * s, -12, -6 * s, 12, -6 * s, 6 * s, 2 * s * s,
      -6 * s, 4 * s * s;
  for (int i = 0; i + 1 < supports; ++i) k.block<4, 4>(2 * i, 2 * i) += a * e;
  for (int i = 0; i < supports; ++i) k(2 * i, 2 * i) += spring;
  Eigen::VectorXd f = Eigen::VectorXd::Zero(n);
  f(2 * (supports / 2)) = load;
  const Eigen::VectorXd u = k.ldlt().solve(f);
  std::vector<double> forces;
  for (int i = 0; i < supports; ++i) forces.push_back(spring * u(2 * i));
  return forces;
}

TEST(TrackBeams, DiscreteSupportsShareALoadAsTheirEquationsSay) {
  const int supports = 41;
  const double spacing = 0.6, spring = 40e6, load = 93e3;
  RailOnFoundation track(spacing * (supports - 1), 4 * (supports - 1), rail, {0, 0});
  std::vector<Index> springs;
  for (int i = 0; i < supports; ++i)
    springs.push_back(track.system.add(
        Link{ClampedSpring{spring, spring, 0}, track.beam.at(i * spacing, track.first, -1), 0}));
  track.load_at(supports / 2 * spacing, load);
  track.system.find_rest();
  const std::vector<double> expected = spring_forces(supports, spacing, spring, load);
  for (std::size_t i = 0; i < expected.size(); ++i)
    EXPECT_NEAR(track.system.forces()(springs[i]), expected[i], 1e-6 * load);
}

/// Deflection under a load that has moved far enough along a rail on a foundation to be steady.
void expect_steady_bow(double speed) {
  const double k = 10e6, m = rail.density * rail.area, load = 93e3;
  const double lambda = std::pow(k / (4 * rail_bending), 0.25);
  const double critical = std::pow(4 * k * rail_bending / (m * m), 0.25), a = speed / critical;
  const double length = 64, from = 16, to = 44, dt = 2.5e-4;
  RailOnFoundation track(length, 480, rail, {k, 0});
  track.load_at(from, load);
  track.system.find_rest();
  track.system.move_by({dt, 0});
  double x = from;
  const double rise = 0.3;  // speeds up slowly, so that nothing swings afterwards [s]
  while (x < to) {
    const double share = std::min(1.0, (track.system.time() + 0.5 * dt) / rise);
    x += speed * share * share * (3 - 2 * share) * dt;
    track.system.move_ends(track.loads[0], track.beam.at(x, track.first, 1));
    track.system.step();
  }
  const double p = std::sqrt(1 - a * a), q = std::sqrt(1 + a * a);
  const double peak = load / (8 * rail_bending * lambda * lambda * lambda * p);
  EXPECT_NEAR(track.sinks_at(x), peak, 2e-4 * peak) << speed;
  for (double xi = -6; xi <= 6; xi += 0.7) {
    const double s = lambda * std::abs(xi);
    const double w = peak * std::exp(-s * p) * (std::cos(q * s) + p / q * std::sin(q * s));
    EXPECT_NEAR(track.sinks_at(x + xi), w, 5e-4 * peak) << speed << " " << xi;
  }
}

TEST(TrackBeams, LoadOnTheMoveDrivesASteadyBow) {
  expect_steady_bow(40);
  expect_steady_bow(80);
}

/// The bridge of the tests: 24 m, simply supported.
struct Bridge {
  static constexpr double length = 24, bending = 4.2e10, line_mass = 8000;
  Beam beam{
      {3.5e10, bending / 3.5e10, 1, line_mass}, even_nodes(0, length, 24), BeamEnd::simple, BeamEnd::simple};
  CoupledSystem system;
  Index first = system.add(std::make_unique<SparsePart>(beam.structure(0)));
  double sinks_at(double x) const {
    double w = 0;
    for (const LinkEnd& end : beam.at(x, first, -1)) w += end.weight * system.displacements()(end.port);
    return w;
  }
};

double moving_force_solution(double x, double t, double v, double load) {
  double w = 0;
  for (int n = 1; n <= 60; ++n) {
    const double q = n * pi / Bridge::length, wn = q * q * std::sqrt(Bridge::bending / Bridge::line_mass),
                 o = q * v;
    w += std::sin(q * x) / (wn * wn - o * o) * (std::sin(o * t) - o / wn * std::sin(wn * t));
  }
  return 2 * load / (Bridge::line_mass * Bridge::length) * w;
}

TEST(TrackBeams, ForceCrossesABridge) {
  const double v = 40, load = 100e3, dt = 2.5e-4;
  Bridge bridge;
  const Index link = bridge.system.add(Link{GivenForce{load}, {}, 0});
  bridge.system.move_by({dt, 0});
  double worst = 0, largest = 0;
  for (int n = 1; n * dt * v < Bridge::length; ++n) {
    bridge.system.move_ends(link, bridge.beam.at(v * n * dt, bridge.first, 1));
    bridge.system.step();
    const double exact = moving_force_solution(12, n * dt, v, load);
    worst = std::max(worst, std::abs(bridge.sinks_at(12) - exact));
    largest = std::max(largest, exact);
  }
  EXPECT_NEAR(largest, 0.7855e-3, 2e-7);  // published
  EXPECT_LT(worst, 2e-4 * largest);
}

/// Largest deflection at mid-span under a mass that is held to the bridge, by the first `modes` sine shapes.
double moving_mass_solution(double mass, double v, double g, int modes) {
  const double length = Bridge::length, half = Bridge::line_mass * length / 2;
  const double dt = 2e-5;
  VectorXd q = VectorXd::Zero(modes), rate = q, before;
  const auto acceleration = [&](double t, const VectorXd& at, const VectorXd& speed) {
    Eigen::MatrixXd m = Eigen::MatrixXd::Zero(modes, modes);
    VectorXd f(modes), s(modes), s1(modes), s2(modes);
    for (int j = 0; j < modes; ++j) {
      const double k = (j + 1) * pi / length;
      s(j) = std::sin(k * v * t), s1(j) = k * std::cos(k * v * t), s2(j) = -k * k * s(j);
      f(j) = -half * std::pow(k, 4) * Bridge::bending / Bridge::line_mass * at(j);
    }
    m = half * Eigen::MatrixXd::Identity(modes, modes) + mass * s * s.transpose();
    f += mass * s * (g - 2 * v * s1.dot(speed) - v * v * s2.dot(at));
    return VectorXd(m.llt().solve(f));
  };
  double largest = 0;
  for (double t = 0; t * v < length; t += dt) {  // Runge-Kutta
    const VectorXd a1 = acceleration(t, q, rate);
    const VectorXd a2 = acceleration(t + dt / 2, q + dt / 2 * rate, rate + dt / 2 * a1);
    const VectorXd a3 = acceleration(t + dt / 2, q + dt / 2 * rate + dt * dt / 4 * a1, rate + dt / 2 * a2);
    const VectorXd a4 = acceleration(t + dt, q + dt * rate + dt * dt / 2 * a2, rate + dt * a3);
    q += dt * rate + dt * dt / 6 * (a1 + a2 + a3);
    rate += dt / 6 * (a1 + 2 * a2 + 2 * a3 + a4);
    double w = 0;
    for (int j = 0; j < modes; ++j) w += q(j) * std::sin((j + 1) * pi / 2);
    largest = std::max(largest, w);
  }
  return largest;
}

/// The same by our parts: the mass stands on a spring, that may be stiff or soft.
double largest_under_sprung_mass(double mass, double spring, double v, double dt) {
  constexpr double g = 9.81;
  Bridge bridge;
  const Index port = bridge.system.add(make_mass(mass, 0, 0, -mass * g));
  const Index link = bridge.system.add(Link{ClampedSpring{spring, spring, 0}, {{port, -1.0}}, 0});
  bridge.system.find_rest();  // the mass falls onto its spring on the rigid approach ...
  bridge.system.move_by({dt, 0});
  double largest = 0;
  for (int n = 1; n * dt * v < Bridge::length; ++n) {  // ... and rolls over the bridge
    std::vector<LinkEnd> ends = bridge.beam.at(v * n * dt, bridge.first, 1);
    ends.push_back({port, -1.0});
    bridge.system.move_ends(link, ends);
    bridge.system.step();
    largest = std::max(largest, bridge.sinks_at(12));
  }
  return largest;
}

TEST(TrackBeams, MassCrossesABridge) {
  const double mass = 100e3 / 9.81, v = 40;
  const double exact = moving_mass_solution(mass, v, 9.81, 20);
  EXPECT_NEAR(exact, 0.7875e-3, 2e-7);  // published
  EXPECT_NEAR(largest_under_sprung_mass(mass, 1e11, v, 2.5e-4), exact, 1e-3 * exact);
}

TEST(TrackBeams, SprungMassLiesBetweenMassAndForce) {
  const double mass = 100e3 / 9.81, v = 40;
  EXPECT_NEAR(largest_under_sprung_mass(mass, 1e3, v, 2.5e-4), 0.7855e-3, 2e-6);
  const double stiff = largest_under_sprung_mass(mass, 1e10, v, 2.5e-4);
  EXPECT_NEAR(stiff, 0.7875e-3, 1e-6);
}

TEST(TrackBeams, ShearMakesAShortBeamSofter) {
  // Cantilever: tip = P L^3 / 3 E I + P L / (G kappa A).
  BeamSection section{3.6e10, 0.24 * std::pow(0.2, 3) / 12, 0.048, 2400, 0.048 * 5 / 6, 0.2};
  const double length = 1.2, load = 1e4, shear = section.young / 2.4;
  const Beam beam(section, even_nodes(0, length, 3), BeamEnd::clamped, BeamEnd::free);
  CoupledSystem system;
  const Index first = system.add(std::make_unique<SparsePart>(beam.structure(0)));
  system.add(Link{GivenForce{load}, beam.at(length, first, 1), 0});
  system.find_rest();
  const double tip = load * std::pow(length, 3) / (3 * section.young * section.second_moment) +
                     load * length / (shear * section.shear_area);
  EXPECT_NEAR(-system.displacements()(beam.port(3)), tip, 1e-8 * tip);
}

TEST(TrackBeams, FrequenciesOfAFreeTimoshenkoBeam) {
  // A simply supported Timoshenko beam: rho I/(k G A) rho A w^4 - (rho A + (rho I + E I rho/(k G)) q^2) w^2 +
  // E I q^4 = 0.
  BeamSection section{3.6e10, 0.24 * std::pow(0.2, 3) / 12, 0.048, 2400, 0.048 * 5 / 6, 0.2};
  const double length = 2.4;
  const Beam beam(section, even_nodes(0, length, 48), BeamEnd::simple, BeamEnd::simple);
  const Structure<SparseMatrix> s = beam.structure(0);
  const Eigen::GeneralizedSelfAdjointEigenSolver<MatrixXd> modes(MatrixXd(s.stiffness), MatrixXd(s.mass));
  const double shear = section.young / 2.4 * section.shear_area, line = section.density * section.area,
               rotary = section.density * section.second_moment,
               bending = section.young * section.second_moment;
  for (int n = 1; n <= 3; ++n) {
    const double q2 = std::pow(n * pi / length, 2);
    const double a = rotary * line / shear, b = line + (rotary + bending * line / shear) * q2,
                 c = bending * q2 * q2;
    const double w2 = (b - std::sqrt(b * b - 4 * a * c)) / (2 * a);
    EXPECT_NEAR(modes.eigenvalues()(n - 1), w2, 1e-3 * w2) << n;
  }
}

}  // namespace
}  // namespace trackbed::fem
