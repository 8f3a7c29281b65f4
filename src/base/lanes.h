// Four numbers at once. Formulas that are worked out for many contacts or stones are templates over a `Real`:
// double for one, Lanes for four. Each lane does exactly what a double would, so that a result does not
// depend on the company in which it was worked out. Needs -ffp-contract=off.
#pragma once

#include <cmath>
#include <cstddef>

#ifdef __AVX__
#include <immintrin.h>
#endif

#include <Eigen/Core>

#include "base/vec.h"

namespace trackbed {

struct Lanes {
  static constexpr int size = 4;
  using Pack = double __attribute__((vector_size(32)));
  Pack pack;

  Lanes() = default;
  Lanes(Pack p) : pack(p) {}
  Lanes(double x) : pack{x, x, x, x} {}
  Lanes(double a, double b, double c, double d) : pack{a, b, c, d} {}
  double operator[](int lane) const { return pack[lane]; }

  Lanes& operator+=(Lanes b) { return *this = pack + b.pack; }
  Lanes& operator-=(Lanes b) { return *this = pack - b.pack; }
  Lanes& operator*=(Lanes b) { return *this = pack * b.pack; }
  Lanes& operator/=(Lanes b) { return *this = pack / b.pack; }

  /// From and to four numbers in a row, wherever they lie.
  static Lanes load(const double* from) {
    Lanes out;
    __builtin_memcpy(&out.pack, from, sizeof out.pack);
    return out;
  }
  void store(double* to) const { __builtin_memcpy(to, &pack, sizeof pack); }
};

}  // namespace trackbed

namespace Eigen {

template <>
struct NumTraits<trackbed::Lanes> : GenericNumTraits<trackbed::Lanes> {
  using Real = trackbed::Lanes;
  using NonInteger = trackbed::Lanes;
  using Nested = trackbed::Lanes;
  using Literal = double;
  enum {
    IsComplex = 0,
    IsInteger = 0,
    IsSigned = 1,
    RequireInitialization = 0,
    ReadCost = 1,
    AddCost = 1,
    MulCost = 1
  };
};

}  // namespace Eigen

namespace trackbed {

inline Lanes operator+(Lanes a, Lanes b) {
  return a.pack + b.pack;
}
inline Lanes operator-(Lanes a, Lanes b) {
  return a.pack - b.pack;
}
inline Lanes operator*(Lanes a, Lanes b) {
  return a.pack * b.pack;
}
inline Lanes operator/(Lanes a, Lanes b) {
  return a.pack / b.pack;
}
inline Lanes operator-(Lanes a) {
  return -a.pack;
}

/// A truth in each lane.
struct LaneMask {
  using Pack = long long __attribute__((vector_size(32)));
  Pack pack;  // all bits set where true
};
inline LaneMask operator<(Lanes a, Lanes b) {
  return {a.pack < b.pack};
}
inline LaneMask operator>(Lanes a, Lanes b) {
  return {a.pack > b.pack};
}
inline LaneMask operator==(Lanes a, Lanes b) {
  return {a.pack == b.pack};
}
inline LaneMask operator&&(LaneMask a, LaneMask b) {
  return {a.pack & b.pack};
}
inline LaneMask operator||(LaneMask a, LaneMask b) {
  return {a.pack | b.pack};
}
inline LaneMask operator!(LaneMask a) {
  return {~a.pack};
}
/// Bit k tells of lane k.
inline unsigned bits(LaneMask m) {
#ifdef __AVX__
  return static_cast<unsigned>(_mm256_movemask_pd(reinterpret_cast<__m256d>(m.pack)));
#else
  unsigned out = 0;
  for (int k = 0; k < Lanes::size; ++k) out |= (m.pack[k] != 0 ? 1u : 0u) << k;
  return out;
#endif
}
inline bool any(LaneMask m) {
  return bits(m) != 0;
}
inline bool any(bool m) {
  return m;
}

/// a where true, b elsewhere. Both are worked out: neither may trap, either may be nonsense where not chosen.
inline Lanes select(LaneMask m, Lanes a, Lanes b) {
  return m.pack ? a.pack : b.pack;
}
inline double select(bool m, double a, double b) {
  return m ? a : b;
}

inline Lanes sqrt(Lanes a) {
  Lanes out;
  for (int k = 0; k < Lanes::size; ++k) out.pack[k] = std::sqrt(a.pack[k]);
  return out;
}
inline double sqrt(double a) {
  return std::sqrt(a);
}
inline Lanes abs(Lanes a) {
  return select(a < Lanes(0.0), -a, a);
}
inline double abs(double a) {
  return std::abs(a);
}
inline Lanes larger(Lanes a, Lanes b) {
  return select(a > b, a, b);
}
inline double larger(double a, double b) {
  return a > b ? a : b;
}

template <class Real>
using Vec3Of = Eigen::Matrix<Real, 3, 1>;
template <class Real>
using Mat3Of = Eigen::Matrix<Real, 3, 3>;

template <class Mask, class Real>
Vec3Of<Real> select(Mask m, const Vec3Of<Real>& a, const Vec3Of<Real>& b) {
  return {select(m, a.x(), b.x()), select(m, a.y(), b.y()), select(m, a.z(), b.z())};
}

/// A vector and a fourth number beside it.
using Row = Lanes;
inline Row row_of(const Vec3& v, double fourth = 0.0) {
  return {v.x(), v.y(), v.z(), fourth};
}
inline Vec3 xyz(Row r) {
  return {r[0], r[1], r[2]};
}
/// Cross product of the vectors; the fourth number becomes 0 when both fourth ones are finite.
inline Row cross(Row a, Row b) {
  const Lanes::Pack a1 = __builtin_shufflevector(a.pack, a.pack, 1, 2, 0, 3);
  const Lanes::Pack a2 = __builtin_shufflevector(a.pack, a.pack, 2, 0, 1, 3);
  const Lanes::Pack b1 = __builtin_shufflevector(b.pack, b.pack, 1, 2, 0, 3);
  const Lanes::Pack b2 = __builtin_shufflevector(b.pack, b.pack, 2, 0, 1, 3);
  return a1 * b2 - a2 * b1;
}

/// Turns four rows of four numbers into their columns, and back.
inline void transpose(Lanes& a, Lanes& b, Lanes& c, Lanes& d) {
  const Lanes::Pack ab0 = __builtin_shufflevector(a.pack, b.pack, 0, 4, 2, 6);
  const Lanes::Pack ab1 = __builtin_shufflevector(a.pack, b.pack, 1, 5, 3, 7);
  const Lanes::Pack cd0 = __builtin_shufflevector(c.pack, d.pack, 0, 4, 2, 6);
  const Lanes::Pack cd1 = __builtin_shufflevector(c.pack, d.pack, 1, 5, 3, 7);
  a.pack = __builtin_shufflevector(ab0, cd0, 0, 1, 4, 5);
  b.pack = __builtin_shufflevector(ab1, cd1, 0, 1, 4, 5);
  c.pack = __builtin_shufflevector(ab0, cd0, 2, 3, 6, 7);
  d.pack = __builtin_shufflevector(ab1, cd1, 2, 3, 6, 7);
}

/// Four vectors that lie one behind the other (twelve numbers), one in each lane; and back.
inline Vec3Of<Lanes> load_vectors(const Vec3* from) {
  const double* f = from->data();
  Lanes a = Lanes::load(f), b = Lanes::load(f + 3), c = Lanes::load(f + 6);
  // The fourth is read from one place before its start: nothing behind the array is touched.
  const Lanes last = Lanes::load(f + 8);
  Lanes d = Lanes(Lanes::Pack(__builtin_shufflevector(last.pack, last.pack, 1, 2, 3, 0)));
  transpose(a, b, c, d);
  return {a, b, c};
}
inline void store_vectors(const Vec3Of<Lanes>& v, Vec3* to) {
  Lanes a = v.x(), b = v.y(), c = v.z(), d = 0.0;
  transpose(a, b, c, d);
  double* t = to->data();
  // Each is written over the surplus number of the one before it.
  a.store(t);
  b.store(t + 3);
  c.store(t + 6);
  for (int k = 0; k < 3; ++k) t[9 + k] = d[k];
}

}  // namespace trackbed
