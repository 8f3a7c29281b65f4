// Parts joined by links: one step of all together.
//
// With the parts' compliances G (part.h) and the links' rows E (closing = E u - gap), the forces f of links
// solve   f = law(closing* - G f, rate* - c G f),  * without coupling forces, G now between links.
// Laws never fall with closing and G is positive, so f minimises a convex function: Newton's method with a
// search along its direction finds it from anywhere. Its linear equations are (D + G) df = ... over links
// with stiffness 1/D, solved by conjugate gradients (in motion; preconditioned by the blocks of groups of
// links) or Cholesky (on the way to rest).
#pragma once

#include <functional>
#include <memory>
#include <vector>

#include "fem/link_law.h"
#include "fem/part.h"

namespace trackbed::fem {

/// Where a link takes hold: its closing grows by `weight` times the displacement of the port.
struct LinkEnd {
  Index port = 0;  // in the numbering of the whole system: first_port(part) + port of the part
  double weight = 1;
};

struct Link {
  LinkLaw law;
  std::vector<LinkEnd> ends;
  double gap = 0;  // to be closed before it acts [m]
  int group =
      -1;  // links that work on each other closely (all of one sleeper) may share a number: it saves time
};

/// Sums since the start of motion [J]: parts, links, and what comes in through links whose ends are moved or
/// whose force is given. Their balance closes as far as the time step is fine.
struct SystemEnergy {
  PartEnergy parts;
  double links = 0;         // stored
  double links_damped = 0;  // by dashpots of links, and by supports that do not give back
  double put_in = 0;        // by moving the ends of links

  double balance() const {
    return parts.kinetic + parts.elastic + parts.damped + parts.numerical + links + links_damped - put_in;
  }
};

class CoupledSystem {
 public:
  /// Adds a part; returns its first port in the whole.
  Index add(std::unique_ptr<Part> part);
  /// Adds a link; returns its number. Throws std::invalid_argument for a law that makes no sense.
  Index add(Link link);

  /// A link's ends from the next step on (a wheel that rolls).
  void move_ends(Index link, std::vector<LinkEnd> ends);
  void set_force(Index link, double force);  ///< of a GivenForce
  void set_gap(Index link, double gap);

  /// Finds rest under the loads. Links without damping decide. Throws RunError when it does not settle.
  void find_rest();
  /// Steps are steps in time from now on; the system may be at rest or not.
  void move_by(const TimeScheme& scheme);
  void step();

  double time() const { return time_; }
  const VectorXd& forces() const { return force_; }      ///< of links [N]
  const VectorXd& closings() const { return closing_; }  ///< of links [m], negative: open by so much
  const VectorXd& displacements() const { return u_; }   ///< of all ports
  const VectorXd& velocities() const { return v_; }      ///< of all ports
  const Link& link(Index k) const { return links_[static_cast<std::size_t>(k)]; }
  Index links() const { return static_cast<Index>(links_.size()); }
  Index ports() const { return u_.size(); }
  SystemEnergy energy() const;

  /// How hard the last step was: Newton's steps and those of conjugate gradients within.
  struct Effort {
    int newton = 0, conjugate = 0;
  };
  const Effort& effort() const { return effort_; }

 private:
  struct LawValues {
    VectorXd force, slope;  // slope: of force against displacement within the step
  };
  struct Group {
    std::vector<Index> links;
    Eigen::MatrixXd compliance;  // G between them
  };
  class Preconditioner;
  struct Placed {
    std::unique_ptr<Part> part;
    Index first = 0;
  };
  void each_part(const std::function<void(Part& part, Index first)>& work) const;
  void predict();
  void solve();
  void advance();
  void book_energy(const VectorXd& force, const VectorXd& closing, const VectorXd& u);
  void make_compliance();
  void make_groups();
  LawValues laws_at(const VectorXd& answer) const;
  VectorXd answer_to(const VectorXd& forces) const;
  double error_of(const VectorXd& residual, const VectorXd& slope) const;
  VectorXd newton_direction(const VectorXd& residual, const VectorXd& slope);
  VectorXd by_factor(const VectorXd& right, const VectorXd& slope) const;
  VectorXd by_conjugate_gradients(const VectorXd& right, const VectorXd& slope);
  double closing_of(const std::vector<LinkEnd>& ends, const VectorXd& ports) const;
  VectorXd closings_of(const VectorXd& ports) const;
  VectorXd to_ports(const VectorXd& forces) const;

  std::vector<Placed> parts_;
  std::vector<Link> links_;
  std::vector<LinkMemory> memory_;
  std::vector<Group> groups_;                    // of links that share a group; made when motion begins
  std::vector<std::vector<LinkEnd>> left_ends_;  // ends of links that were moved, as they were; else empty
  VectorXd u_, v_, predicted_u_, predicted_v_;   // of ports
  VectorXd force_, closing_, last_force_;        // of links; last: a step earlier
  VectorXd free_closing_, free_rate_;            // of links, without coupling forces
  VectorXd port_compliance_, compliance_;        // diagonals: of ports, of links
  Eigen::MatrixXd all_compliance_;               // between links, on the way to rest
  double velocity_per_displacement_ = 0;         // [1/s]
  double step_ = 0, time_ = 0;                   // [s]
  double links_damped_ = 0, put_in_ = 0;         // [J]
  bool at_rest_ = true;
  Effort effort_;
};

}  // namespace trackbed::fem
