// The end of a contact.
#pragma once

#include "dem/laws/table.h"

namespace trackbed {

/// Ends a contact. Its last force goes on acting in the step in which it opens, on average by half: what its
/// springs held and did not give back so becomes heat.
inline void open_contact(const ContactProperties& p, const ContactKinematics& k, ContactMemory& memory,
                         Losses& losses) {
  if (p.ks > 0) {
    losses.friction += memory.shear.squaredNorm() / (2.0 * p.ks) - 0.5 * k.dt * memory.shear.dot(k.velocity);
    if (p.law == LawKind::linear_rolling)
      losses.rolling += memory.rolling.squaredNorm() / (2.0 * LinearRolling::rolling_stiffness(p, k.radius)) -
                        0.5 * k.dt * memory.rolling.dot(k.spin);
  }
  memory = {};
}

}  // namespace trackbed
