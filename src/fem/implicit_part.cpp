#include "fem/implicit_part.h"

#include <stdexcept>
#include <utility>

namespace trackbed::fem {
namespace {

// Up to so many ports of a sparse structure their compliance is kept as a matrix; beyond, a solve is cheaper.
constexpr Index most_condensed_ports = 100;

double inner(const MatrixXd& a, const MatrixXd& b) {
  return a.cwiseProduct(b).sum();
}

}  // namespace

template <class Matrix>
ImplicitPart<Matrix>::ImplicitPart(Structure<Matrix> structure, Index copies)
    : structure_(std::move(structure)) {
  const Index n = structure_.mass.rows();
  if (structure_.stiffness.rows() != n || structure_.damping.rows() != n || structure_.load.size() != n ||
      structure_.ports.rows() != n || copies < 1)
    throw std::invalid_argument("matrices of a part do not fit each other");
  u_ = v_ = a_ = start_u_ = start_v_ = delta_ = MatrixXd::Zero(n, copies);
  force_ = structure_.load.replicate(1, copies);
}

template <class Matrix>
void ImplicitPart<Matrix>::refactor(const Matrix& matrix, double per_force) {
  factor_ = std::make_unique<Factor>(matrix);
  if (factor_->info() != Eigen::Success) throw std::invalid_argument("a part's matrices are not positive");
  per_force_ = per_force;
  const Index p = structure_.ports.cols();
  if (std::is_same_v<Matrix, SparseMatrix> && p > most_condensed_ports) return;
  by_ports_ = per_force * factor_->solve(MatrixXd(structure_.ports));
  port_compliance_ = structure_.ports.transpose() * by_ports_;
}

template <class Matrix>
void ImplicitPart<Matrix>::move_by(const TimeScheme& scheme) {
  scheme_ = scheme;
  at_rest_ = false;
  const double dt = scheme.step, weight = 1 + scheme.alpha;
  refactor(structure_.mass / (scheme.beta() * dt * dt) +
               weight * (scheme.velocity_per_displacement() * structure_.damping + structure_.stiffness),
           weight);
  a_ = Factor(structure_.mass).solve(force_ - structure_.damping * v_ - structure_.stiffness * u_);
  lost_ = {};
}

template <class Matrix>
void ImplicitPart<Matrix>::rest_by(double shift) {
  shift_ = shift;
  at_rest_ = true;
  v_.setZero();
  a_.setZero();
  refactor(structure_.stiffness + shift * structure_.mass, 1);
}

template <class Matrix>
void ImplicitPart<Matrix>::predict(Eigen::Ref<VectorXd> displacement, Eigen::Ref<VectorXd> velocity) {
  const auto& [mass, damping, stiffness, load, ports] = structure_;
  if (at_rest_) {
    start_u_ = u_;
    delta_ = factor_->solve(load.replicate(1, u_.cols()) - stiffness * u_);
    write_ports(start_u_ + delta_, displacement);
    velocity.setZero();
    return;
  }
  const double dt = scheme_.step, beta = scheme_.beta(), gamma = scheme_.gamma(), alpha = scheme_.alpha;
  start_u_ = u_ + dt * v_ + dt * dt * (0.5 - beta) * a_;
  start_v_ = v_ + dt * (1 - gamma) * a_;
  MatrixXd unbalanced =
      (1 + alpha) * (load.replicate(1, u_.cols()) - damping * start_v_ - stiffness * start_u_);
  if (alpha != 0) unbalanced -= alpha * (force_ - damping * v_ - stiffness * u_);
  delta_ = factor_->solve(unbalanced);
  write_ports(start_u_ + delta_, displacement);
  write_ports(start_v_ + scheme_.velocity_per_displacement() * delta_, velocity);
}

template <class Matrix>
MatrixXd ImplicitPart<Matrix>::forces_of(const Eigen::Ref<const VectorXd>& force) const {
  return structure_.ports * force.reshaped(structure_.ports.cols(), u_.cols());
}

template <class Matrix>
MatrixXd ImplicitPart<Matrix>::answer(const Eigen::Ref<const VectorXd>& force) const {
  if (by_ports_.size() > 0) return by_ports_ * force.reshaped(structure_.ports.cols(), u_.cols());
  return per_force_ * factor_->solve(forces_of(force));
}

template <class Matrix>
void ImplicitPart<Matrix>::write_ports(const MatrixXd& coordinates, Eigen::Ref<VectorXd> out) const {
  out.reshaped(structure_.ports.cols(), u_.cols()) = structure_.ports.transpose() * coordinates;
}

template <class Matrix>
void ImplicitPart<Matrix>::respond(const Eigen::Ref<const VectorXd>& force,
                                   Eigen::Ref<VectorXd> displacement) const {
  const Index p = structure_.ports.cols();
  if (by_ports_.size() > 0)
    displacement.reshaped(p, u_.cols()).noalias() = port_compliance_ * force.reshaped(p, u_.cols());
  else
    write_ports(answer(force), displacement);
}

template <class Matrix>
VectorXd ImplicitPart<Matrix>::compliance() const {
  const Index p = structure_.ports.cols();
  VectorXd of_one(p);
  if (by_ports_.size() > 0) {
    of_one = port_compliance_.diagonal();
  } else {
    for (Index k = 0; k < p; ++k) {
      const VectorXd column = structure_.ports.col(k);
      of_one(k) = per_force_ * column.dot(VectorXd(factor_->solve(column)));
    }
  }
  return of_one.replicate(u_.cols(), 1);
}

template <class Matrix>
void ImplicitPart<Matrix>::advance(const Eigen::Ref<const VectorXd>& force) {
  const MatrixXd delta = delta_ + answer(force);
  const MatrixXd forces = forces_of(force).colwise() + structure_.load;
  if (at_rest_) {
    u_ = start_u_ + delta;
    force_ = forces;
    return;
  }
  end_step(start_u_ + delta, start_v_ + scheme_.velocity_per_displacement() * delta,
           delta / (scheme_.beta() * scheme_.step * scheme_.step), forces);
}

/// Constant mean acceleration keeps the change of energy equal to the mean forces' work; what is missing is
/// the work of the time scheme.
template <class Matrix>
void ImplicitPart<Matrix>::end_step(const MatrixXd& u, const MatrixXd& v, const MatrixXd& a, MatrixXd force) {
  const MatrixXd moved = u - u_;
  const double damped = inner(moved, structure_.damping * (0.5 * (v_ + v)));
  const double gained = inner(0.5 * (v_ + v), structure_.mass * (v - v_)) +
                        inner(moved, structure_.stiffness * (0.5 * (u_ + u)));
  lost_.damped += damped;
  lost_.numerical += inner(moved, 0.5 * (force_ + force)) - damped - gained;
  u_ = u;
  v_ = v;
  a_ = a;
  force_ = std::move(force);
}

template <class Matrix>
void ImplicitPart<Matrix>::state(Eigen::Ref<VectorXd> displacement, Eigen::Ref<VectorXd> velocity) const {
  write_ports(u_, displacement);
  write_ports(v_, velocity);
}

template <class Matrix>
PartEnergy ImplicitPart<Matrix>::energy() const {
  PartEnergy energy = lost_;
  energy.kinetic = 0.5 * inner(v_, structure_.mass * v_);
  energy.elastic =
      0.5 * inner(u_, structure_.stiffness * u_) - inner(u_, structure_.load.replicate(1, u_.cols()));
  return energy;
}

template class ImplicitPart<SparseMatrix>;
template class ImplicitPart<MatrixXd>;

}  // namespace trackbed::fem
