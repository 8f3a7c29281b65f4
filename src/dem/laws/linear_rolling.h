// The linear law with rolling resistance (PFC's "rrlinear"; Iwashita & Oda 1998, type C of Ai et al. 2011
// without its viscous part): an elastic rolling moment, cut at friction x normal force x effective radius.
#pragma once

#include "dem/laws/linear.h"

namespace trackbed {

struct LinearRolling {
  static constexpr std::string_view name = "linear_rolling";
  static constexpr LawKind kind = LawKind::linear_rolling;
  static constexpr bool rolls = true;

  template <class Real>
  static ContactForceOf<Real> respond(const ContactKinematicsOf<Real>& k, const ContactProperties& p,
                                      ContactMemoryOf<Real>& memory, LossesOf<Real>& losses) {
    const Real dt = k.dt, zero = 0.0;
    const Real opening = k.velocity.dot(k.normal);
    const Real share = Linear::active_share(k, memory, opening);
    const Vec3Of<Real> before = select(
        memory.touches(), carry_along<Real>(memory.rolling, memory.normal, k.normal, k.mean_twist * dt),
        Vec3Of<Real>(Vec3Of<Real>::Zero()));
    ContactForceOf<Real> out = Linear::respond(k, p, memory, losses);

    const Real stiffness = rolling_stiffness(p, k.radius);
    const Vec3Of<Real> bend = (k.spin - k.spin.dot(k.normal) * k.normal) * dt;
    Vec3Of<Real> moment = before - (stiffness * share) * bend;
    const Real limit = Real(p.rolling_friction * p.kn) * k.radius * k.overlap;
    const Real trial2 = moment.squaredNorm();
    const auto slips = trial2 > limit * limit;
    if (any(slips)) moment *= select(slips, limit / sqrt(trial2), Real(1.0));
    const auto loses = slips || share < Real(1.0);
    if (p.ks > 0 && any(loses)) {
      const Vec3Of<Real> lost_bend = bend + (Real(1.0) / stiffness) * (moment - before);
      losses.rolling -= select(loses, Real(0.5) * (before + moment).dot(lost_bend), zero);
    }
    memory.rolling = moment;
    out.moment += moment;
    return out;
  }

  /// k_r = k_s R^2 [N m/rad].
  template <class Real>
  static Real rolling_stiffness(const ContactProperties& p, const Real& radius) {
    return Real(p.ks) * radius * radius;
  }
};

}  // namespace trackbed
