#include "dem/rotation.h"

#include <gtest/gtest.h>

#include <numbers>

namespace trackbed {
namespace {

double energy(const Quat& q, const Vec3& inertia, const Vec3& momentum) {
  return 0.5 * momentum.dot(spin_of<double>(q.toRotationMatrix(), inertia.cwiseInverse(), momentum));
}

/// Angle between two orientations [rad].
double angle(const Quat& a, const Quat& b) {
  return 2.0 * std::asin((a.conjugate() * b).vec().norm());
}

Quat turned(Quat q, const Vec3& momentum, const Vec3& inertia, double time, int steps) {
  for (int k = 0; k < steps; ++k) rotate_freely(q, momentum, inertia, time / steps);
  return q;
}

const Quat start = Quat(0.5, -0.3, 0.7, 0.2).normalized();
const Vec3 momentum(0.3, -0.2, 0.5);

TEST(Rotation, SpinIsMomentumOverInertiaInTheBodysAxes) {
  const Vec3 inertia(1, 2, 4), spin(0.3, -1, 2);
  const Mat3 r = start.toRotationMatrix();
  const Mat3 tensor = r * inertia.asDiagonal() * r.transpose();
  EXPECT_LT((spin_of<double>(r, inertia.cwiseInverse(), tensor * spin) - spin).norm(), 1e-14);
}

TEST(Rotation, BallTurnsAboutItsMomentum) {
  const Vec3 inertia = Vec3::Constant(0.7);
  const double time = 2.0;
  const Quat expected(Eigen::AngleAxisd(momentum.norm() / 0.7 * time, momentum.normalized()) * start);
  EXPECT_LT(angle(turned(start, momentum, inertia, time, 20000), expected), 1e-8);
}

TEST(Rotation, ABodyThatSpinsAboutAPrincipalAxisKeepsIt) {
  const Vec3 inertia(1, 2, 4);
  for (int axis = 0; axis < 3; ++axis) {
    const Vec3 along = start * Vec3::Unit(axis);
    const Quat q = turned(start, 3.0 * along, inertia, 0.01, 10);
    EXPECT_LT((q * Vec3::Unit(axis) - along).norm(), 1e-14);
    EXPECT_NEAR(angle(q, start), 0.01 * 3.0 / inertia[axis], 3e-8);
  }
}

// The axis of a symmetric top goes round its angular momentum at |L|/I_1.
TEST(Rotation, SymmetricTopPrecesses) {
  const Vec3 inertia(1.5, 1.5, 0.6);
  const double time = 2 * std::numbers::pi * 1.5 / momentum.norm();
  const Vec3 axis = start * Vec3::UnitZ();
  EXPECT_LT((turned(start, momentum, inertia, time, 4000) * Vec3::UnitZ() - axis).norm(), 1e-5);
  EXPECT_LT((turned(start, momentum, inertia, time / 2, 4000) * Vec3::UnitZ() -
             Eigen::AngleAxisd(std::numbers::pi, momentum.normalized()) * axis)
                .norm(),
            1e-5);
}

TEST(Rotation, ErrorFallsWithTheSquareOfTheStep) {
  const Vec3 inertia(1, 1.7, 2.2);
  const Quat fine = turned(start, 10 * momentum, inertia, 1.0, 64000);
  const double coarse = angle(turned(start, 10 * momentum, inertia, 1.0, 200), fine);
  const double half = angle(turned(start, 10 * momentum, inertia, 1.0, 400), fine);
  EXPECT_NEAR(coarse / half, 4.0, 0.05);
}

// Turns back to where it came from: no direction of time is preferred.
TEST(Rotation, RunsBackwards) {
  const Vec3 inertia(1, 1.7, 2.2);
  const Quat there = turned(start, momentum, inertia, 3.0, 300);
  EXPECT_LT(angle(turned(there, momentum, inertia, -3.0, 300), start), 1e-12);
}

// Tumbling about the middle axis, which is not stable: ten thousand steps of 0.02 rad, no drift.
TEST(Rotation, EnergyStaysWithoutDrift) {
  const Vec3 inertia(1, 1.7, 2.2);
  Quat q = start;
  const Vec3 l = start * Vec3(0.01, 1.7, 0.02);
  const double e0 = energy(q, inertia, l);
  double early = 0, late = 0;
  for (int k = 0; k < 10000; ++k) {
    rotate_freely(q, l, inertia, 0.02);
    double& worst = k < 5000 ? early : late;
    worst = std::max(worst, std::abs(energy(q, inertia, l) / e0 - 1));
  }
  EXPECT_NEAR(q.norm(), 1.0, 1e-14);
  EXPECT_LT(early, 1e-4);
  EXPECT_LT(late, 1.05 * early);
}

}  // namespace
}  // namespace trackbed
