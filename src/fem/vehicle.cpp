#include "fem/vehicle.h"

namespace trackbed::fem {
namespace {

/// Adds a spring and dashpot along a row of coordinates: force = k (row . q).
void add_spring(Structure<MatrixXd>& s, const VectorXd& row, const Suspension& spring) {
  s.stiffness += spring.stiffness * row * row.transpose();
  s.damping += spring.damping * row * row.transpose();
}

}  // namespace

Structure<MatrixXd> vehicle_structure(const Vehicle& v, double gravity) {
  constexpr Index n = 10, car = 0, first_wheel = 6;
  Structure<MatrixXd> s{MatrixXd::Zero(n, n), MatrixXd::Zero(n, n), MatrixXd::Zero(n, n), VectorXd::Zero(n),
                        MatrixXd::Zero(n, 4)};
  s.mass.diagonal() << v.car_mass, v.car_pitch_inertia, v.bogie_mass, v.bogie_pitch_inertia, v.bogie_mass,
      v.bogie_pitch_inertia, VectorXd::Constant(4, v.wheelset_mass);
  for (const Index z : {0, 2, 4, 6, 7, 8, 9}) s.load(z) = -gravity * s.mass(z, z);
  for (Index b = 0; b < 2; ++b) {
    const Index bogie = 2 + 2 * b;
    const double ahead = b == 0 ? 1 : -1;
    VectorXd row = VectorXd::Zero(n);
    row(car) = 1;
    row(car + 1) = ahead * v.bogie_distance / 2;
    row(bogie) = -1;
    add_spring(s, row, v.secondary);
    row.setZero();
    row(car + 1) = 1;
    row(bogie + 1) = -1;
    add_spring(s, row, {v.secondary_bending, 0});
    for (Index w = 0; w < 2; ++w) {
      row.setZero();
      row(bogie) = 1;
      row(bogie + 1) = (w == 0 ? 1 : -1) * v.wheelbase / 2;
      row(first_wheel + 2 * b + w) = -1;
      add_spring(s, row, v.primary);
    }
  }
  for (Index w = 0; w < 4; ++w) s.ports(first_wheel + w, w) = 1;
  return s;
}

}  // namespace trackbed::fem
