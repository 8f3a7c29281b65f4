// A part given by its matrices, stepped by the alpha method with one factor for all steps.
#pragma once

#include <Eigen/Cholesky>
#include <Eigen/Core>
#include <Eigen/SparseCholesky>
#include <Eigen/SparseCore>
#include <memory>
#include <type_traits>

#include "fem/part.h"

namespace trackbed::fem {

using Eigen::MatrixXd;
using SparseMatrix = Eigen::SparseMatrix<double>;

/// Symmetric matrices of one structure with n coordinates; `Matrix` is MatrixXd or SparseMatrix.
template <class Matrix>
struct Structure {
  Matrix mass, damping, stiffness;  // n x n
  VectorXd load;                    // constant: weight [N]
  SparseMatrix ports;               // n x p: how port forces act
};

/// One structure, or many alike that share their factor (sleepers). Ports and coordinates of copy c lie
/// behind those of copy c - 1.
template <class Matrix>
class ImplicitPart : public Part {
 public:
  /// Throws std::invalid_argument when sizes do not fit.
  explicit ImplicitPart(Structure<Matrix> structure, Index copies = 1);

  Index ports() const override { return structure_.ports.cols() * u_.cols(); }
  void move_by(const TimeScheme& scheme) override;
  void rest_by(double shift) override;
  void predict(Eigen::Ref<VectorXd> displacement, Eigen::Ref<VectorXd> velocity) override;
  void respond(const Eigen::Ref<const VectorXd>& force, Eigen::Ref<VectorXd> displacement) const override;
  VectorXd compliance() const override;
  void advance(const Eigen::Ref<const VectorXd>& force) override;
  void state(Eigen::Ref<VectorXd> displacement, Eigen::Ref<VectorXd> velocity) const override;
  PartEnergy energy() const override;

  const Structure<Matrix>& structure() const { return structure_; }
  /// Coordinates and their rates, n x copies; may be set before the first step in time.
  MatrixXd& displacement() { return u_; }
  MatrixXd& velocity() { return v_; }
  MatrixXd& acceleration() { return a_; }
  const MatrixXd& displacement() const { return u_; }
  const MatrixXd& velocity() const { return v_; }
  const MatrixXd& acceleration() const { return a_; }

 private:
  using Factor = std::conditional_t<std::is_same_v<Matrix, MatrixXd>, Eigen::LLT<MatrixXd>,
                                    Eigen::SimplicialLLT<SparseMatrix>>;
  void refactor(const Matrix& matrix, double per_force);
  MatrixXd answer(const Eigen::Ref<const VectorXd>& force) const;
  MatrixXd forces_of(const Eigen::Ref<const VectorXd>& force) const;
  void write_ports(const MatrixXd& coordinates, Eigen::Ref<VectorXd> out) const;
  void end_step(const MatrixXd& u, const MatrixXd& v, const MatrixXd& a, MatrixXd force);

  Structure<Matrix> structure_;
  MatrixXd u_, v_, a_;          // n x copies
  MatrixXd force_;              // at the start of the step, the constant load with them
  MatrixXd start_u_, start_v_;  // end of the step if it ended without acceleration (Newmark's predictor)
  MatrixXd delta_;              // from there to the end of the step without coupling forces
  MatrixXd by_ports_;           // n x p: answer of the coordinates to unit forces at ports, when p is small
  MatrixXd port_compliance_;    // p x p, likewise
  std::unique_ptr<Factor> factor_;
  TimeScheme scheme_;
  double shift_ = 0;      // [1/s^2]
  double per_force_ = 1;  // 1 + alpha, or 1 on the way to rest
  bool at_rest_ = true;   // steps look for rest
  PartEnergy lost_;
};

using SparsePart = ImplicitPart<SparseMatrix>;
using DensePart = ImplicitPart<MatrixXd>;

}  // namespace trackbed::fem
