// The linear contact law with Coulomb friction (Cundall & Strack 1979), in the absolute form of PFC's
// "linear" model, and its dashpots.
#pragma once

#include <string_view>

#include "dem/contact.h"
#include "dem/material.h"

namespace trackbed {

struct Linear {
  static constexpr std::string_view name = "linear";
  static constexpr LawKind kind = LawKind::linear;
  static constexpr bool rolls = false;

  /// Force of a touching contact; updates its memory. `losses` gains what was dissipated.
  template <class Real>
  static ContactForceOf<Real> respond(const ContactKinematicsOf<Real>& k, const ContactProperties& p,
                                      ContactMemoryOf<Real>& memory, LossesOf<Real>& losses) {
    const Real dt = k.dt, zero = 0.0;
    const Real normal_force = Real(p.kn) * k.overlap;
    const Real opening = k.velocity.dot(k.normal);
    const Vec3Of<Real> sliding = (k.velocity - opening * k.normal) * dt;
    const Real share = active_share(k, memory, opening);
    const Vec3Of<Real> before =
        select(memory.touches(), carry_along<Real>(memory.shear, memory.normal, k.normal, k.mean_twist * dt),
               Vec3Of<Real>(Vec3Of<Real>::Zero()));

    // Elastic increment, cut to the Coulomb cone. What the force takes over the whole step and the spring
    // does not store is lost: the work of the cut part, and of the way before a contact closed.
    Vec3Of<Real> shear = before - (Real(p.ks) * share) * sliding;
    const Real limit = Real(p.friction) * normal_force;
    const Real trial2 = shear.squaredNorm();
    const auto slips = trial2 > limit * limit;
    if (any(slips)) shear *= select(slips, limit / sqrt(trial2), Real(1.0));
    const auto loses = slips || share < Real(1.0);
    if (p.ks > 0 && any(loses)) {
      const Vec3Of<Real> lost_way = sliding + Real(1.0 / p.ks) * (shear - before);
      losses.friction -= select(loses, Real(0.5) * (before + shear).dot(lost_way), zero);
    }
    memory.overlap = k.overlap;
    memory.normal = k.normal;
    memory.shear = shear;

    ContactForceOf<Real> out{normal_force * k.normal + shear, Vec3Of<Real>::Zero()};
    if (p.dashpot.normal > 0 || p.dashpot.shear > 0) add_dashpot(k, p, slips, normal_force, out, losses);
    return out;
  }

  /// Share of the step during which the contact touched: a contact that closed within it moved freely before.
  template <class Real>
  static Real active_share(const ContactKinematicsOf<Real>& k, const ContactMemoryOf<Real>& memory,
                           const Real& opening) {
    const auto is_new = !memory.touches();
    if (!any(is_new)) return 1.0;
    const Real approach = -opening * Real(k.dt);
    return select(is_new && approach > k.overlap, k.overlap / approach, Real(1.0));
  }

 private:
  template <class Real, class Truth>
  static void add_dashpot(const ContactKinematicsOf<Real>& k, const ContactProperties& p, const Truth& slips,
                          const Real& normal_force, ContactForceOf<Real>& out, LossesOf<Real>& losses) {
    const Real opening = k.velocity.dot(k.normal);
    const Vec3Of<Real> sliding = k.velocity - opening * k.normal;
    const bool no_tension =
        p.dashpot.mode == DashpotMode::no_tension || p.dashpot.mode == DashpotMode::no_tension_slip_cut;
    const bool slip_cut =
        p.dashpot.mode == DashpotMode::full_slip_cut || p.dashpot.mode == DashpotMode::no_tension_slip_cut;

    Real normal = Real(-2.0 * p.dashpot.normal) * sqrt(k.reduced_mass * Real(p.kn)) * opening;
    if (no_tension) normal = larger(normal, -normal_force);
    Real across = Real(2.0 * p.dashpot.shear) * sqrt(k.reduced_mass * Real(p.ks));
    if (slip_cut) across = select(slips, Real(0.0), across);
    const Vec3Of<Real> viscous = normal * k.normal - across * sliding;
    losses.dashpot -= viscous.dot(k.velocity) * Real(k.dt);
    out.force += viscous;
  }
};

}  // namespace trackbed
