#include "fem/link_law.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <stdexcept>

namespace trackbed::fem {
namespace {

struct Curve {
  double force, slope;
};

/// First loading of a measured support, along its last line beyond its last point.
Curve loading(const MeasuredSupport& law, double closing) {
  if (closing <= law.closing.front()) return {0, 0};
  auto k = static_cast<std::size_t>(std::ranges::lower_bound(law.closing, closing) - law.closing.begin());
  k = std::min(k, law.closing.size() - 1);
  const double slope = (law.force[k] - law.force[k - 1]) / (law.closing[k] - law.closing[k - 1]);
  return {law.force[k - 1] + slope * (closing - law.closing[k - 1]), slope};
}

LinkForce force(const GivenForce& law, const LinkMemory&, double, double) {
  return {law.force, 0, 0};
}

LinkForce force(const ClampedSpring& law, const LinkMemory&, double closing, double rate) {
  const double stiffness = closing >= 0 ? law.compression : law.tension;
  return {stiffness * closing + law.damping * rate, stiffness, law.damping};
}

LinkForce force(const OneSidedSpring& law, const LinkMemory&, double closing, double) {
  return closing > 0 ? LinkForce{law.stiffness * closing, law.stiffness, 0} : LinkForce{};
}

LinkForce force(const HertzContact& law, const LinkMemory&, double closing, double) {
  if (closing <= 0) return {};
  const double root = std::sqrt(closing);
  return {law.constant * closing * root, 1.5 * law.constant * root, 0};
}

LinkForce force(const MeasuredSupport& law, const LinkMemory& memory, double closing, double) {
  if (closing >= memory.deepest) {
    const auto [value, slope] = loading(law, closing);
    return {value, slope, 0};
  }
  const double value = loading(law, memory.deepest).force - law.unloading * (memory.deepest - closing);
  return value > 0 ? LinkForce{value, law.unloading, 0} : LinkForce{};
}

void require(bool ok, const char* sentence) {
  if (!ok) throw std::invalid_argument(sentence);
}

void check_one(const GivenForce&) {}
void check_one(const ClampedSpring& law) {
  require(law.compression >= 0 && law.tension >= 0 && law.damping >= 0,
          "a fastener's constants are not negative");
}
void check_one(const OneSidedSpring& law) {
  require(law.stiffness >= 0, "a contact's stiffness is not negative");
}
void check_one(const HertzContact& law) {
  require(law.constant >= 0, "a Hertzian constant is not negative");
}
void check_one(const MeasuredSupport& law) {
  const auto& x = law.closing;
  const auto& f = law.force;
  require(x.size() >= 2 && x.size() == f.size(), "a support's curve has two points or more, a force to each");
  require(f.front() == 0, "a support's curve begins with no force");
  for (std::size_t k = 1; k < x.size(); ++k) {
    require(x[k] > x[k - 1] && f[k] >= f[k - 1], "a support's curve rises from point to point");
    require((f[k] - f[k - 1]) <= law.unloading * (x[k] - x[k - 1]) * (1 + 1e-9),
            "a support unloads at least as steeply as it loads");
  }
}

}  // namespace

LinkForce force_of(const LinkLaw& law, const LinkMemory& memory, double closing, double rate) {
  return std::visit([&](const auto& one) { return force(one, memory, closing, rate); }, law);
}

double stored_energy(const LinkLaw& law, const LinkMemory& memory, double closing) {
  const LinkForce now = force_of(law, memory, closing, 0);
  if (std::holds_alternative<GivenForce>(law)) return now.force * closing;
  if (std::holds_alternative<HertzContact>(law)) return 0.4 * now.force * std::max(closing, 0.0);
  if (const auto* measured = std::get_if<MeasuredSupport>(&law))
    return measured->unloading > 0 ? 0.5 * now.force * now.force / measured->unloading : 0;
  return 0.5 * now.force * closing;
}

double hertz_stiffness(double constant, double force) {
  return 1.5 * std::cbrt(constant * constant * force);
}

void check(const LinkLaw& law) {
  std::visit([](const auto& one) { check_one(one); }, law);
}

}  // namespace trackbed::fem
