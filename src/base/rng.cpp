#include "base/rng.h"

#include <cmath>
#include <numbers>

#include "base/hash.h"

namespace trackbed {
namespace {

std::uint64_t stream_of(std::string_view purpose) {
  Hash hash;
  hash.add(purpose);
  return hash.value();
}

}  // namespace

Rng::Rng(std::uint64_t seed, std::string_view purpose) : engine_(seed, stream_of(purpose)) {}

double Rng::uniform() {
  const std::uint64_t high = engine_() >> 5u;
  const std::uint64_t low = engine_() >> 6u;
  return (static_cast<double>(high) * 67108864.0 + static_cast<double>(low)) / 9007199254740992.0;
}

double Rng::uniform(double low, double high) {
  return low + (high - low) * uniform();
}

double Rng::normal() {
  const double radius = std::sqrt(-2.0 * std::log(1.0 - uniform()));
  return radius * std::cos(2.0 * std::numbers::pi * uniform());
}

std::uint32_t Rng::index(std::uint32_t n) {
  return engine_(n);
}

Quat Rng::rotation() {
  const double u = uniform();
  const double a = 2.0 * std::numbers::pi * uniform();
  const double b = 2.0 * std::numbers::pi * uniform();
  const double s = std::sqrt(1.0 - u);
  const double t = std::sqrt(u);
  return {t * std::cos(b), s * std::sin(a), s * std::cos(a), t * std::sin(b)};
}

}  // namespace trackbed
