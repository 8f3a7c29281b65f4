// The time scheme on one mass: order, energy, damping of fast motion.
#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <cmath>
#include <numbers>

#include "scenes/track_parts.h"

namespace trackbed::fem {
namespace {

/// Displacement after `time` of a mass of frequency w that starts at 1.
double swung(double w, double time, int steps, double alpha) {
  CoupledSystem system;
  auto mass = make_mass(1, w * w, 0, 0);
  mass->place(MatrixXd::Ones(1, 1), MatrixXd::Zero(1, 1));
  system.add(std::move(mass));
  system.move_by({time / steps, alpha});
  for (int k = 0; k < steps; ++k) system.step();
  return system.displacements()(0);
}

TEST(TrackTime, ErrorsFallWithTheSquareOfTheStep) {
  const double w = 2 * std::numbers::pi, time = 1.3;
  for (const double alpha : {0.0, -0.1}) {
    const double coarse = swung(w, time, 200, alpha) - std::cos(w * time);
    const double fine = swung(w, time, 400, alpha) - std::cos(w * time);
    EXPECT_NEAR(coarse / fine, 4, 0.1) << alpha;
    EXPECT_LT(std::abs(fine), 1e-3);
  }
}

TEST(TrackTime, NewmarkKeepsTheAmplitude) {
  CoupledSystem system;
  auto mass = make_mass(2, 800, 0, 0);
  mass->place(MatrixXd::Ones(1, 1), MatrixXd::Zero(1, 1));
  system.add(std::move(mass));
  system.move_by({0.03, 0});
  const double start = system.energy().parts.elastic;
  for (int k = 0; k < 5000; ++k) system.step();
  const PartEnergy end = system.energy().parts;
  EXPECT_NEAR(end.kinetic + end.elastic, start, 1e-10 * start);
  EXPECT_NEAR(end.numerical, 0, 1e-10 * start);
}

/// Greatest absolute eigenvalue of the alpha method's amplification matrix (Hughes 1987, section 9.3), worked
/// out from its equations for (u, dt v, dt^2 a) of a mass of 1.
double spectral_radius(double w_dt, double alpha) {
  const TimeScheme s{1, alpha};
  const double b = s.beta(), g = s.gamma(), k = w_dt * w_dt;
  Eigen::Matrix3d left, right;
  left << 1, 0, -b, 0, 1, -g, (1 + alpha) * k, 0, 1;
  right << 1, 1, 0.5 - b, 0, 1, 1 - g, alpha * k, 0, 0;
  return (left.inverse() * right).eval().eigenvalues().cwiseAbs().maxCoeff();
}

TEST(TrackTime, AlphaDampsAsItsSpectralRadiusSays) {
  // Far beyond the step: (1 + alpha) / (1 - alpha) at alpha = -0.3 (double root), 1/2 at -1/3.
  EXPECT_NEAR(spectral_radius(1e5, -1.0 / 3), 0.5, 1e-3);
  for (const double alpha : {-0.05, -0.2, -0.3}) {
    for (const double w_dt : {0.5, 2.0, 20.0}) {
      CoupledSystem system;
      auto mass = make_mass(1, w_dt * w_dt, 0, 0);
      DensePart& part = *mass;
      part.place(MatrixXd::Ones(1, 1), MatrixXd::Zero(1, 1));
      system.add(std::move(mass));
      system.move_by({1, alpha});
      const int steps = 400, skipped = 200;  // the double root at large w_dt takes its time
      double early = 0, late = 0;
      for (int k = 0; k < steps; ++k) {
        system.step();
        const double size = std::hypot(part.displacement()(0, 0), part.velocity()(0, 0) / w_dt,
                                       part.acceleration()(0, 0) / (w_dt * w_dt));
        if (k >= skipped - 40 && k < skipped) early = std::max(early, size);
        if (k >= steps - 40) late = std::max(late, size);
      }
      const double found = std::pow(late / early, 1.0 / (steps - skipped));
      EXPECT_NEAR(found, spectral_radius(w_dt, alpha), 5e-3) << alpha << " " << w_dt;
    }
  }
}

}  // namespace
}  // namespace trackbed::fem
