#include "dem/material.h"

#include <algorithm>

namespace trackbed {
namespace {

double in_series(double a, double b) {
  return a > 0 && b > 0 ? a * b / (a + b) : 0.0;
}

ContactProperties combine(const Material& a, const Material& b, LawKind law, Inheritance inheritance) {
  ContactProperties p;
  p.law = law;
  p.kn = inheritance == Inheritance::series ? in_series(a.kn, b.kn) : std::min(a.kn, b.kn);
  p.ks = inheritance == Inheritance::series ? in_series(a.ks, b.ks) : std::min(a.ks, b.ks);
  p.friction = std::min(a.friction, b.friction);
  p.rolling_friction = std::min(a.rolling_friction, b.rolling_friction);
  // A moment that is always cut to nothing need not be worked out.
  if (p.rolling_friction == 0) p.law = LawKind::linear;
  return p;
}

}  // namespace

PairTable::PairTable(const std::vector<Material>& materials, LawKind law, const Dashpot& dashpot,
                     Inheritance inheritance)
    : n_(static_cast<int>(materials.size())) {
  for (const Material& a : materials) {
    for (const Material& b : materials) {
      table_.push_back(combine(a, b, law, inheritance));
      table_.back().dashpot = dashpot;
    }
  }
}

PairTable PairTable::with_friction_up_to(double friction) const {
  PairTable table = *this;
  for (ContactProperties& p : table.table_) p.friction = std::min(p.friction, friction);
  return table;
}

double PairTable::stiffest(int material) const {
  double k = 0;
  for (int other = 0; other < n_; ++other)
    k = std::max({k, (*this)(material, other).kn, (*this)(material, other).ks});
  return k;
}

}  // namespace trackbed
