// The linear law with rolling resistance (PFC's "rrlinear"; Iwashita & Oda 1998, type C of Ai et al. 2011
// without its viscous part): an elastic rolling moment, cut at friction x normal force x effective radius.
#pragma once

#include "dem/laws/linear.h"

namespace trackbed {

struct LinearRolling {
  static constexpr std::string_view name = "linear_rolling";
  static constexpr LawKind kind = LawKind::linear_rolling;
  static constexpr bool rolls = true;

  static ContactForce respond(const ContactKinematics& k, const ContactProperties& p, ContactMemory& memory,
                              Losses& losses) {
    const double opening = k.velocity.dot(k.normal);
    const double share = Linear::active_share(k, memory, opening);
    const Vec3 before = memory.touches()
                            ? carry_along(memory.rolling, memory.normal, k.normal, k.mean_twist * k.dt)
                            : Vec3::Zero();
    ContactForce out = Linear::respond(k, p, memory, losses);

    const double stiffness = rolling_stiffness(p, k.radius);
    const Vec3 bend = (k.spin - k.spin.dot(k.normal) * k.normal) * k.dt;
    Vec3 moment = before - stiffness * share * bend;
    const double limit = p.rolling_friction * k.radius * p.kn * k.overlap;
    const double trial2 = moment.squaredNorm();
    const bool slips = trial2 > limit * limit;
    if (slips) moment *= limit / std::sqrt(trial2);
    if (stiffness > 0 && (slips || share < 1.0))
      losses.rolling -= 0.5 * (before + moment).dot(bend + (moment - before) / stiffness);
    memory.rolling = moment;
    out.moment += moment;
    return out;
  }

  /// k_r = k_s R^2 [N m/rad].
  static double rolling_stiffness(const ContactProperties& p, double radius) {
    return p.ks * radius * radius;
  }
};

}  // namespace trackbed
