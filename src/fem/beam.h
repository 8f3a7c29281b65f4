// Straight beams of two-node elements in one plane: deflection w (up) and slope dw/dx of the axis' normal at
// each node.
#pragma once

#include <vector>

#include "fem/coupled_system.h"
#include "fem/implicit_part.h"

namespace trackbed::fem {

struct BeamSection {
  double young = 0;          // E [Pa]
  double second_moment = 0;  // I [m^4]
  double area = 0;           // A [m^2]
  double density = 0;        // rho [kg/m^3]
  double shear_area = 0;     // kappa A [m^2]; 0: does not shear (Euler-Bernoulli), no rotary inertia
  double poisson = 0.3;      // for the shear modulus
  double damping = 0;        // share of the stiffness, C = damping K [s]
};

/// What lies under a beam everywhere (Winkler).
struct Foundation {
  double stiffness = 0;  // [N/m per m]
  double damping = 0;    // [N s/m per m]
};

enum class BeamEnd { free, simple, clamped, guided };  ///< guided: slope held, deflection free (symmetry)

/// Elements take the exact static shape of a Timoshenko beam (Przemieniecki 1968), so nodes are exact under
/// loads at nodes; the consistent mass goes with it.
class Beam {
 public:
  /// `nodes`: places along the beam, ascending [m], two at least. Throws std::invalid_argument.
  Beam(const BeamSection& section, std::vector<double> nodes, BeamEnd left, BeamEnd right);

  /// Matrices and weight; `gravity` [m/s^2] downwards. Every free coordinate is a port.
  Structure<SparseMatrix> structure(double gravity, const Foundation& foundation = {}) const;

  /// How the deflection at x hangs on the ports: the ends of a link there, `first_port` being the beam's.
  /// Throws std::out_of_range beyond the ends.
  std::vector<LinkEnd> at(double x, Index first_port, double weight) const;
  /// The port of a node's deflection; -1 where it is held.
  Index port(std::size_t node) const { return coordinate_[2 * node]; }
  Index ports() const { return free_; }
  const std::vector<double>& nodes() const { return nodes_; }

 private:
  BeamSection section_;
  std::vector<double> nodes_;
  std::vector<Index> coordinate_;  // of w and slope of each node; -1: held
  Index free_ = 0;
};

/// Shape functions of an element of length L at xi in 0..1: of deflection and of slope, for w1, slope1, w2,
/// slope2.
struct BeamShape {
  Eigen::Vector4d deflection, slope;
};
BeamShape beam_shape(const BeamSection& section, double length, double xi);

/// `parts` equal steps from a to b, both ends with them.
std::vector<double> even_nodes(double a, double b, int parts);

}  // namespace trackbed::fem
