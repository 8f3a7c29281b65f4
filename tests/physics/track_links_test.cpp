// Links between parts against formulas: wheel on rail, bilinear fastener, impact, a gap that closes.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <vector>

#include "fem/beam.h"
#include "scenes/track_parts.h"

namespace trackbed::fem {
namespace {

using std::numbers::pi;

/// A mass above the ground, held by one link that closes as it sinks.
struct MassOnLink {
  CoupledSystem system;
  DensePart* mass;
  MassOnLink(double kilograms, double weight, LinkLaw law, double gap) {
    auto part = make_mass(kilograms, 0, 0, -weight);
    mass = part.get();
    const Index port = system.add(std::move(part));
    system.add(Link{std::move(law), {{port, -1.0}}, gap});
  }
  double height() const { return system.displacements()(0); }
};

TEST(TrackLinks, WheelRestsWhereHertzSays) {
  const double constant = 9e10, load = 93e3;
  MassOnLink scene(load / 9.81, load, HertzContact{constant}, 0);
  scene.system.find_rest();
  EXPECT_NEAR(scene.system.closings()(0), std::pow(load / constant, 2.0 / 3), 1e-9 * 1e-4);
  EXPECT_NEAR(scene.system.forces()(0), load, 1e-6 * load);
}

TEST(TrackLinks, DroppedMassBouncesAsHighAsItFell) {
  const double m = 10, k = 1e7, gap = 0.05, g = 9.81, dt = 2e-6;
  MassOnLink scene(m, m * g, OneSidedSpring{k}, gap);
  scene.system.move_by({dt, 0});
  double in_touch = 0, highest = -1;
  bool has_touched = false;
  for (int n = 0; n < 120000; ++n) {
    scene.system.step();
    if (scene.system.forces()(0) > 0)
      in_touch += dt, has_touched = true;
    else if (has_touched)
      highest = std::max(highest, scene.height());
  }
  // Under weight the touch lasts a little longer than half a period: 2 atan(w v / g) + ... = pi + 2 g / (w
  // v).
  const double w = std::sqrt(k / m), v = std::sqrt(2 * g * gap);
  EXPECT_NEAR(in_touch, (pi + 2 * std::atan(g / (w * v))) / w, 2.5 * dt);
  EXPECT_NEAR(highest, 0, 1e-4 * gap);
}

/// The mass between its fastener's two stiffnesses, driven by P sin(W t): each half is a linear oscillator
/// whose solution is known; the moment of change is found by bisection.
class ExactBilinear {
 public:
  ExactBilinear(double m, double k1, double k2, double c, double p, double w)
      : m_(m), k_{k1, k2}, c_(c), p_(p), w_(w) {}
  void advance_to(double time) {
    while (t_ < time) {
      const double end = time;
      const bool side = x_ > 0 || (x_ == 0 && v_ > 0);
      double low = t_, high = end;
      if (stays(side, t_, end)) {
        go(side, end);
        return;
      }
      for (int n = 0; n < 200 && high - low > 1e-17; ++n) {
        const double middle = 0.5 * (low + high);
        (at(side, middle).first > 0) == side ? low = middle : high = middle;
      }
      go(side, high);
      x_ = 0;
    }
  }
  double position() const { return x_; }

 private:
  bool stays(bool side, double from, double to) const {
    for (int n = 1; n <= 64; ++n) {
      const double x = at(side, from + (to - from) * n / 64).first;
      if ((x > 0) != side) return false;
    }
    return true;
  }
  std::pair<double, double> at(bool side, double time) const {
    const double k = k_[side ? 0 : 1], w0 = std::sqrt(k / m_), d = c_ / (2 * m_),
                 wd = std::sqrt(w0 * w0 - d * d);
    const double a = k - m_ * w_ * w_, b = c_ * w_, size = p_ / (a * a + b * b);
    const auto forced = [&](double t) { return size * (a * std::sin(w_ * t) - b * std::cos(w_ * t)); };
    const auto forced_rate = [&](double t) {
      return size * w_ * (a * std::cos(w_ * t) + b * std::sin(w_ * t));
    };
    const double x0 = x_ - forced(t_), v0 = v_ - forced_rate(t_), s = time - t_;
    const double e = std::exp(-d * s), cs = std::cos(wd * s), sn = std::sin(wd * s), q = (v0 + d * x0) / wd;
    return {e * (x0 * cs + q * sn) + forced(time),
            e * ((-d * x0 + q * wd) * cs + (-d * q - wd * x0) * sn) + forced_rate(time)};
  }
  void go(bool side, double time) {
    const auto [x, v] = at(side, time);
    x_ = x, v_ = v, t_ = time;
  }
  double m_, k_[2], c_, p_, w_, x_ = 0, v_ = 0, t_ = 0;
};

TEST(TrackLinks, BilinearFastenerFollowsThePiecewiseSolution) {
  const double m = 150, k1 = 1.2e8, k2 = 1.2e9, c = 5e4, p = 20e3, w = 2 * pi * 40, dt = 1e-6;
  MassOnLink scene(m, 0, ClampedSpring{k1, k2, c}, 0);
  const Index push = scene.system.add(Link{GivenForce{0}, {{0, 1.0}}, 0});
  scene.system.move_by({dt, 0});
  ExactBilinear exact(m, k1, k2, c, p, w);
  double worst = 0, largest = 0, exchanged = 0;
  for (int n = 1; n <= 100000; ++n) {  // four periods
    // A link pushes itself open: a positive force on the mass sinks it, as a closing fastener counts.
    scene.system.set_force(push, p * std::sin(w * n * dt));
    scene.system.step();
    if (n % 10 == 0) {
      exact.advance_to(n * dt);
      worst = std::max(worst, std::abs(-scene.height() - exact.position()));
      largest = std::max(largest, std::abs(exact.position()));
      const SystemEnergy e = scene.system.energy();
      exchanged = std::max({exchanged, e.parts.kinetic, e.links_damped});
    }
  }
  EXPECT_LT(worst, 1e-3 * largest);
  EXPECT_GT(exchanged, 1);  // [J]
  EXPECT_NEAR(scene.system.energy().balance() / exchanged, 0, 1e-6);
}

TEST(TrackLinks, HangingBeamClosesItsGapAtTheForceOfItsBending) {
  // Clamped at both ends, pushed at the middle: w = P L^3 / (192 E I).
  const double span = 6, gap = 4e-3, stiffness = 1e9;
  const BeamSection rail{2.1e11, 2338e-8, 69.77e-4, 7850};
  const Beam beam(rail, even_nodes(0, span, 8), BeamEnd::clamped, BeamEnd::clamped);
  const double closing_force = 192 * rail.young * rail.second_moment / (span * span * span) * gap;
  for (const double factor : {0.999, 1.5}) {
    CoupledSystem system;
    const Index first = system.add(std::make_unique<SparsePart>(beam.structure(0)));
    const Index ground = system.add(Link{OneSidedSpring{stiffness}, beam.at(span / 2, first, -1), gap});
    system.add(Link{GivenForce{factor * closing_force}, beam.at(span / 2, first, 1), 0});
    system.find_rest();
    // Beyond, beam and ground share what comes on top as springs side by side.
    const double beam_stiffness = closing_force / gap, beyond = std::max(0.0, factor - 1) * closing_force;
    EXPECT_NEAR(system.forces()(ground), beyond * stiffness / (stiffness + beam_stiffness),
                1e-6 * closing_force);
    if (factor < 1) {
      EXPECT_NEAR(system.closings()(ground), (factor - 1) * gap, 1e-8 * gap);
    }
  }
}

}  // namespace
}  // namespace trackbed::fem
