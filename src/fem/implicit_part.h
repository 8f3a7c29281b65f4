// A part given by its matrices, stepped by the alpha method with one factor for all steps.
#pragma once

#include <Eigen/Cholesky>
#include <Eigen/Core>
#include <Eigen/SparseCholesky>
#include <Eigen/SparseCore>
#include <memory>

#include "fem/modal_matrix.h"
#include "fem/part.h"

namespace trackbed::fem {

using Eigen::MatrixXd;
using SparseMatrix = Eigen::SparseMatrix<double>;

/// What goes with a kind of matrix: how it is factored, and how ports are kept.
template <class Matrix>
struct MatrixKind;
template <>
struct MatrixKind<SparseMatrix> {
  using Factor = Eigen::SimplicialLLT<SparseMatrix>;
  using Ports = SparseMatrix;
};
template <>
struct MatrixKind<MatrixXd> {
  using Factor = Eigen::LLT<MatrixXd>;
  using Ports = MatrixXd;
};
template <>
struct MatrixKind<ModalMatrix> {
  using Factor = ModalFactor;
  using Ports = MatrixXd;
};

/// Symmetric matrices of one structure with n coordinates.
template <class Matrix>
struct Structure {
  Matrix mass, damping, stiffness;           // n x n
  VectorXd load;                             // constant: weight [N]
  typename MatrixKind<Matrix>::Ports ports;  // n x p: how port forces act
  bool held = false;                         // does the stiffness alone hold it?
};

/// One structure, or many alike that share their factor (sleepers). Ports and coordinates of copy c lie
/// behind those of copy c - 1.
template <class Matrix>
class ImplicitPart : public Part {
 public:
  /// Throws std::invalid_argument when sizes do not fit.
  explicit ImplicitPart(Structure<Matrix> structure, Index copies = 1);

  Index ports() const override { return port_u_.size(); }
  void move_by(const TimeScheme& scheme) override;
  void rest_by(double shift) override;
  void predict(Eigen::Ref<VectorXd> displacement, Eigen::Ref<VectorXd> velocity) override;
  void respond(const Eigen::Ref<const VectorXd>& force, Eigen::Ref<VectorXd> displacement) const override;
  VectorXd compliance() const override;
  void advance(const Eigen::Ref<const VectorXd>& force) override;
  void state(Eigen::Ref<VectorXd> displacement, Eigen::Ref<VectorXd> velocity) const override;
  PartEnergy energy() const override;

  const Structure<Matrix>& structure() const { return structure_; }
  /// Coordinates and their rates, n x copies.
  const MatrixXd& displacement() const { return u_; }
  const MatrixXd& velocity() const { return v_; }
  const MatrixXd& acceleration() const { return a_; }
  /// Sets off from here; before motion begins.
  void place(const MatrixXd& displacement, const MatrixXd& velocity);

 private:
  using Factor = typename MatrixKind<Matrix>::Factor;
  void refactor(const Matrix& matrix, double per_force);
  MatrixXd answer(const Eigen::Ref<const VectorXd>& force) const;
  void end_step(const MatrixXd& delta);

  Structure<Matrix> structure_;
  MatrixXd u_, v_, a_;          // n x copies
  MatrixXd unbalanced_;         // F - C v - K u at the start of the step
  MatrixXd start_u_, start_v_;  // end of the step if it ended without acceleration (Newmark's predictor)
  MatrixXd delta_;              // from there to the end of the step without coupling forces
  MatrixXd by_ports_;           // n x p: answer of the coordinates to unit forces at ports, when p is small
  MatrixXd port_compliance_;    // p x p, likewise
  VectorXd port_u_, port_v_, port_a_;  // of all copies
  VectorXd port_delta_;                // of delta_
  VectorXd port_force_;                // at the start of the step
  VectorXd free_u_, free_v_;           // ports at the end of the step without coupling forces
  std::unique_ptr<Factor> factor_;
  TimeScheme scheme_;
  double per_force_ = 1;  // 1 + alpha, or 1 on the way to rest
  bool at_rest_ = true;   // steps look for rest
  PartEnergy lost_;
};

using SparsePart = ImplicitPart<SparseMatrix>;
using DensePart = ImplicitPart<MatrixXd>;
using ModalPart = ImplicitPart<ModalMatrix>;

}  // namespace trackbed::fem
