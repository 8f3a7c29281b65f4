// Materials and what two of them make of a contact.
#pragma once

#include <string>
#include <vector>

namespace trackbed {

/// Surface properties of a stone, wall or body. Stiffnesses belong to the piece: two pieces in touch are two
/// springs in series.
struct Material {
  std::string name;
  double kn = 0;                // normal stiffness [N/m]
  double ks = 0;                // shear stiffness [N/m]
  double friction = 0;          // Coulomb coefficient [-]
  double rolling_friction = 0;  // limit of the rolling moment over normal force x effective radius [-]
  double density = 0;           // of stones and bodies made of it [kg/m^3]
};

enum class LawKind { linear, linear_rolling };

/// Which dashpot forces act (PFC's modes): whether the normal dashpot may pull, and whether the shear dashpot
/// acts while the contact slips.
enum class DashpotMode { full, no_tension, full_slip_cut, no_tension_slip_cut };

/// Viscous part of the law; fractions of critical damping.
struct Dashpot {
  double normal = 0;  // [-]
  double shear = 0;   // [-]
  DashpotMode mode = DashpotMode::full;
  template <class A>
  void archive(A& a) {
    a(normal, shear, mode);
  }
};

/// What the law needs to know of a material pair.
struct ContactProperties {
  LawKind law = LawKind::linear;
  double kn = 0;                // of the contact [N/m]
  double ks = 0;                // of the contact [N/m]
  double friction = 0;          // [-]
  double rolling_friction = 0;  // [-]
  Dashpot dashpot;
  template <class A>
  void archive(A& a) {
    a(law, kn, ks, friction, rolling_friction, dashpot);
  }
};

/// How piece properties make contact properties.
enum class Inheritance {
  series,  // piece stiffnesses in series; the smaller friction (PFC's property inheritance)
  contact  // the stones' values are those of the contact; against a wall, the stone's stiffness
};

/// Properties of every pair of materials, symmetric.
class PairTable {
 public:
  PairTable() = default;
  PairTable(const std::vector<Material>& materials, LawKind law, const Dashpot& dashpot,
            Inheritance inheritance = Inheritance::series);

  const ContactProperties& operator()(int a, int b) const {
    return table_[static_cast<std::size_t>(a * n_ + b)];
  }
  ContactProperties& operator()(int a, int b) { return table_[static_cast<std::size_t>(a * n_ + b)]; }
  int size() const { return n_; }

  /// Number of a pair, whichever way round, and its properties.
  int index(int a, int b) const { return a < b ? a * n_ + b : b * n_ + a; }
  const ContactProperties& operator[](int index) const { return table_[static_cast<std::size_t>(index)]; }

  /// The same pairs with no more friction than this.
  PairTable with_friction_up_to(double friction) const;

  /// Largest normal or shear stiffness a piece of this material can meet [N/m].
  double stiffest(int material) const;

  template <class A>
  void archive(A& a) {
    a(n_, table_);
  }

 private:
  int n_ = 0;
  std::vector<ContactProperties> table_;
};

}  // namespace trackbed
