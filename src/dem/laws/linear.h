// The linear contact law with Coulomb friction (Cundall & Strack 1979), in the absolute form of PFC's
// "linear" model, and its dashpots.
#pragma once

#include <algorithm>
#include <cmath>
#include <string_view>

#include "dem/contact.h"
#include "dem/material.h"

namespace trackbed {

struct Linear {
  static constexpr std::string_view name = "linear";
  static constexpr LawKind kind = LawKind::linear;
  static constexpr bool rolls = false;

  /// Force of a touching contact; updates its memory. `losses` gains what was dissipated.
  static ContactForce respond(const ContactKinematics& k, const ContactProperties& p, ContactMemory& memory,
                              Losses& losses) {
    const double normal_force = p.kn * k.overlap;
    const double opening = k.velocity.dot(k.normal);
    const Vec3 sliding = (k.velocity - opening * k.normal) * k.dt;
    const double share = active_share(k, memory, opening);
    const Vec3 before = memory.touches()
                            ? carry_along(memory.shear, memory.normal, k.normal, k.mean_twist * k.dt)
                            : Vec3::Zero();

    // Elastic increment, cut to the Coulomb cone. What the force takes over the whole step and the spring
    // does not store is lost: the work of the cut part, and of the way before a contact closed.
    Vec3 shear = before - p.ks * share * sliding;
    const double limit = p.friction * normal_force;
    const double trial2 = shear.squaredNorm();
    const bool slips = trial2 > limit * limit;
    if (slips) shear *= limit / std::sqrt(trial2);
    if (p.ks > 0 && (slips || share < 1.0))
      losses.friction -= 0.5 * (before + shear).dot(sliding + (shear - before) / p.ks);
    memory.overlap = k.overlap;
    memory.normal = k.normal;
    memory.shear = shear;

    ContactForce out{normal_force * k.normal + shear, Vec3::Zero()};
    if (p.dashpot.normal > 0 || p.dashpot.shear > 0) add_dashpot(k, p, slips, normal_force, out, losses);
    return out;
  }

  /// Share of the step during which the contact touched: a contact that closed within it moved freely before.
  static double active_share(const ContactKinematics& k, const ContactMemory& memory, double opening) {
    if (memory.touches()) return 1.0;
    const double approach = -opening * k.dt;
    return approach > k.overlap ? k.overlap / approach : 1.0;
  }

 private:
  static void add_dashpot(const ContactKinematics& k, const ContactProperties& p, bool slips,
                          double normal_force, ContactForce& out, Losses& losses) {
    const double opening = k.velocity.dot(k.normal);
    const Vec3 sliding = k.velocity - opening * k.normal;
    const bool no_tension =
        p.dashpot.mode == DashpotMode::no_tension || p.dashpot.mode == DashpotMode::no_tension_slip_cut;
    const bool slip_cut =
        p.dashpot.mode == DashpotMode::full_slip_cut || p.dashpot.mode == DashpotMode::no_tension_slip_cut;

    double normal = -2.0 * p.dashpot.normal * std::sqrt(k.reduced_mass * p.kn) * opening;
    if (no_tension) normal = std::max(normal, -normal_force);
    Vec3 viscous = normal * k.normal;
    if (!(slip_cut && slips)) viscous -= 2.0 * p.dashpot.shear * std::sqrt(k.reduced_mass * p.ks) * sliding;
    losses.dashpot -= viscous.dot(k.velocity) * k.dt;
    out.force += viscous;
  }
};

}  // namespace trackbed
