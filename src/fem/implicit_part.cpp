#include "fem/implicit_part.h"

#include <stdexcept>
#include <type_traits>
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
  unbalanced_ = structure_.load.replicate(1, copies);
  port_u_ = port_v_ = port_a_ = port_delta_ = port_force_ = free_u_ = free_v_ =
      VectorXd::Zero(structure_.ports.cols() * copies);
}

template <class Matrix>
void ImplicitPart<Matrix>::place(const MatrixXd& displacement, const MatrixXd& velocity) {
  u_ = displacement;
  v_ = velocity;
  const Index p = structure_.ports.cols();
  port_u_.reshaped(p, u_.cols()) = structure_.ports.transpose() * u_;
  port_v_.reshaped(p, u_.cols()) = structure_.ports.transpose() * v_;
  unbalanced_ = structure_.load.replicate(1, u_.cols()) - structure_.damping * v_ - structure_.stiffness * u_;
}

template <class Matrix>
void ImplicitPart<Matrix>::refactor(const Matrix& matrix, double per_force) {
  factor_ = std::make_unique<Factor>(matrix);
  if (factor_->info() != Eigen::Success) throw std::invalid_argument("a part's matrices are not positive");
  per_force_ = per_force;
  if (std::is_same_v<Matrix, SparseMatrix> && structure_.ports.cols() > most_condensed_ports) return;
  by_ports_ = per_force * factor_->solve(MatrixXd(structure_.ports));
  port_compliance_ = structure_.ports.transpose() * by_ports_;
}

template <class Matrix>
void ImplicitPart<Matrix>::move_by(const TimeScheme& scheme) {
  scheme_ = scheme;
  at_rest_ = false;
  const double dt = scheme.step, weight = 1 + scheme.alpha;
  refactor((1 / (scheme.beta() * dt * dt)) * structure_.mass +
               weight * (scheme.velocity_per_displacement() * structure_.damping + structure_.stiffness),
           weight);
  a_ = Factor(structure_.mass).solve(unbalanced_);
  port_a_ = (structure_.ports.transpose() * a_).reshaped();
  lost_ = {};
}

template <class Matrix>
void ImplicitPart<Matrix>::rest_by(double shift) {
  at_rest_ = true;
  v_.setZero();
  a_.setZero();
  port_v_.setZero();
  if (!structure_.held)
    refactor(structure_.stiffness + shift * structure_.mass, 1);
  else if (by_ports_.size() == 0)
    refactor(structure_.stiffness, 1);
}

template <class Matrix>
void ImplicitPart<Matrix>::predict(Eigen::Ref<VectorXd> displacement, Eigen::Ref<VectorXd> velocity) {
  const auto& [mass, damping, stiffness, load, ports, held] = structure_;
  const MatrixXd loads = load.replicate(1, u_.cols());
  if (at_rest_) {
    start_u_ = u_;
    start_v_.setZero();
    delta_ = factor_->solve(loads - stiffness * u_);
  } else {
    const double dt = scheme_.step, beta = scheme_.beta(), gamma = scheme_.gamma(), alpha = scheme_.alpha;
    start_u_ = u_ + dt * v_ + dt * dt * (0.5 - beta) * a_;
    start_v_ = v_ + dt * (1 - gamma) * a_;
    delta_ = factor_->solve((1 + alpha) * (loads - damping * start_v_ - stiffness * start_u_) -
                            alpha * unbalanced_);
  }
  // Ports follow the same rule as coordinates: their large matrix is read once.
  port_delta_ = (ports.transpose() * delta_).reshaped();
  free_u_ = port_u_ + port_delta_;
  if (at_rest_) {
    free_v_.setZero();
  } else {
    const double dt = scheme_.step;
    free_u_ += dt * port_v_ + dt * dt * (0.5 - scheme_.beta()) * port_a_;
    free_v_ =
        port_v_ + dt * (1 - scheme_.gamma()) * port_a_ + scheme_.velocity_per_displacement() * port_delta_;
  }
  displacement = free_u_;
  velocity = free_v_;
}

template <class Matrix>
MatrixXd ImplicitPart<Matrix>::answer(const Eigen::Ref<const VectorXd>& force) const {
  const auto forces = force.reshaped(structure_.ports.cols(), u_.cols());
  if (by_ports_.size() > 0) return by_ports_ * forces;
  return per_force_ * factor_->solve(MatrixXd(structure_.ports * forces));
}

template <class Matrix>
void ImplicitPart<Matrix>::respond(const Eigen::Ref<const VectorXd>& force,
                                   Eigen::Ref<VectorXd> displacement) const {
  const Index p = structure_.ports.cols(), copies = u_.cols();
  if (by_ports_.size() > 0)
    displacement.reshaped(p, copies).noalias() = port_compliance_ * force.reshaped(p, copies);
  else
    displacement.reshaped(p, copies) = structure_.ports.transpose() * answer(force);
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
  VectorXd moved(ports());
  respond(force, moved);
  const VectorXd port_u = free_u_ + moved;
  if (!at_rest_) {
    port_v_ = free_v_ + scheme_.velocity_per_displacement() * moved;
    port_a_ = (port_delta_ + moved) / (scheme_.beta() * scheme_.step * scheme_.step);
    lost_.numerical += 0.5 * (port_force_ + force).dot(port_u - port_u_);
    end_step(delta);
  } else {
    u_ = start_u_ + delta;
    const auto forces = force.reshaped(structure_.ports.cols(), u_.cols());
    unbalanced_ = MatrixXd(structure_.ports * forces).colwise() + structure_.load;
    unbalanced_ -= structure_.stiffness * u_;
  }
  port_u_ = port_u;
  port_force_ = force;
}

/// Constant mean acceleration keeps the change of energy equal to the mean forces' work; what is missing is
/// the work of the time scheme.
template <class Matrix>
void ImplicitPart<Matrix>::end_step(const MatrixXd& delta) {
  const double alpha = scheme_.alpha;
  const MatrixXd u = start_u_ + delta, v = start_v_ + scheme_.velocity_per_displacement() * delta;
  const MatrixXd moved = u - u_, mean_v = 0.5 * (v_ + v);
  a_ = delta / (scheme_.beta() * scheme_.step * scheme_.step);
  unbalanced_ = (structure_.mass * a_ + alpha * unbalanced_) / (1 + alpha);
  const double damped = inner(moved, structure_.damping * mean_v);
  const double gained = inner(mean_v, structure_.mass * MatrixXd(v - v_)) +
                        inner(moved, structure_.stiffness * MatrixXd(0.5 * (u_ + u))) -
                        inner(moved, structure_.load.replicate(1, u_.cols()));
  lost_.damped += damped;
  lost_.numerical -= damped + gained;
  u_ = u;
  v_ = v;
}

template <class Matrix>
void ImplicitPart<Matrix>::state(Eigen::Ref<VectorXd> displacement, Eigen::Ref<VectorXd> velocity) const {
  displacement = port_u_;
  velocity = port_v_;
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
template class ImplicitPart<ModalMatrix>;

}  // namespace trackbed::fem
