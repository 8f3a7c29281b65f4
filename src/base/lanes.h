// Several numbers at once: as many as the processor takes, four or eight. Formulas that are worked out for
// many contacts or stones are templates over a `Real`: double for one, Lanes for several. Each lane does
// exactly what a double would, so that a result does not depend on the company in which it was worked out,
// nor on how many lanes there are. Needs -ffp-contract=off.
#pragma once

#include <array>
#include <cmath>
#include <cstddef>

#ifdef __AVX__
#include <immintrin.h>
#endif

#include <Eigen/Core>

#include "base/vec.h"

namespace trackbed {

namespace lanes_detail {
template <int Size>
struct PackOf;
template <>
struct PackOf<4> {
  using Numbers = double __attribute__((vector_size(32)));
  using Truths = long long __attribute__((vector_size(32)));
};
template <>
struct PackOf<8> {
  using Numbers = double __attribute__((vector_size(64)));
  using Truths = long long __attribute__((vector_size(64)));
};
}  // namespace lanes_detail

template <int Size>
struct LanesOf {
  static constexpr int size = Size;
  using Pack = typename lanes_detail::PackOf<Size>::Numbers;
  Pack pack;

  LanesOf() = default;
  LanesOf(Pack p) : pack(p) {}
  LanesOf(double x) : pack(x - Pack{}) {}

  double operator[](int lane) const { return pack[lane]; }

  LanesOf& operator+=(LanesOf b) { return *this = pack + b.pack; }
  LanesOf& operator-=(LanesOf b) { return *this = pack - b.pack; }
  LanesOf& operator*=(LanesOf b) { return *this = pack * b.pack; }
  LanesOf& operator/=(LanesOf b) { return *this = pack / b.pack; }

  friend LanesOf operator+(LanesOf a, LanesOf b) { return a.pack + b.pack; }
  friend LanesOf operator-(LanesOf a, LanesOf b) { return a.pack - b.pack; }
  friend LanesOf operator*(LanesOf a, LanesOf b) { return a.pack * b.pack; }
  friend LanesOf operator/(LanesOf a, LanesOf b) { return a.pack / b.pack; }
  friend LanesOf operator-(LanesOf a) { return -a.pack; }

  /// From and to numbers in a row, wherever they lie.
  static LanesOf load(const double* from) {
    LanesOf out;
    __builtin_memcpy(&out.pack, from, sizeof out.pack);
    return out;
  }
  void store(double* to) const { __builtin_memcpy(to, &pack, sizeof pack); }
};

#ifdef __AVX512DQ__
using Lanes = LanesOf<8>;
#else
using Lanes = LanesOf<4>;
#endif

/// A vector and a fourth number beside it.
using Row = LanesOf<4>;

/// The numbers that of(0), of(1), ... give.
template <class Of>
Lanes each_lane(const Of& of) {
  std::array<double, Lanes::size> numbers;
  for (std::size_t k = 0; k < numbers.size(); ++k) numbers[k] = of(k);
  return Lanes::load(numbers.data());
}

}  // namespace trackbed

namespace Eigen {

template <int Size>
struct NumTraits<trackbed::LanesOf<Size>> : GenericNumTraits<trackbed::LanesOf<Size>> {
  using Real = trackbed::LanesOf<Size>;
  using NonInteger = Real;
  using Nested = Real;
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

/// A truth in each lane.
struct LaneMask {
  using Pack = lanes_detail::PackOf<Lanes::size>::Truths;
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
#if defined(__AVX512DQ__)
  return static_cast<unsigned>(_mm512_movepi64_mask(reinterpret_cast<__m512i>(m.pack)));
#elif defined(__AVX__)
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

inline Row row_of(const Vec3& v, double fourth = 0.0) {
  return Row::Pack{v.x(), v.y(), v.z(), fourth};
}
inline Vec3 xyz(Row r) {
  return {r[0], r[1], r[2]};
}
/// Cross product of the vectors; the fourth number becomes 0 when both fourth ones are finite.
inline Row cross(Row a, Row b) {
  const Row::Pack a1 = __builtin_shufflevector(a.pack, a.pack, 1, 2, 0, 3);
  const Row::Pack a2 = __builtin_shufflevector(a.pack, a.pack, 2, 0, 1, 3);
  const Row::Pack b1 = __builtin_shufflevector(b.pack, b.pack, 1, 2, 0, 3);
  const Row::Pack b2 = __builtin_shufflevector(b.pack, b.pack, 2, 0, 1, 3);
  return a1 * b2 - a2 * b1;
}

using Rows = std::array<Row, Lanes::size>;
using Columns = std::array<Lanes, 4>;

namespace lanes_detail {

/// Turns blocks of four rows of four numbers, side by side, into their columns, and back.
inline void transpose(std::array<LanesOf<4>, 4>& rows) {
  auto& [a, b, c, d] = rows;
  const auto ab0 = __builtin_shufflevector(a.pack, b.pack, 0, 4, 2, 6);
  const auto ab1 = __builtin_shufflevector(a.pack, b.pack, 1, 5, 3, 7);
  const auto cd0 = __builtin_shufflevector(c.pack, d.pack, 0, 4, 2, 6);
  const auto cd1 = __builtin_shufflevector(c.pack, d.pack, 1, 5, 3, 7);
  a.pack = __builtin_shufflevector(ab0, cd0, 0, 1, 4, 5);
  b.pack = __builtin_shufflevector(ab1, cd1, 0, 1, 4, 5);
  c.pack = __builtin_shufflevector(ab0, cd0, 2, 3, 6, 7);
  d.pack = __builtin_shufflevector(ab1, cd1, 2, 3, 6, 7);
}
inline void transpose(std::array<LanesOf<8>, 4>& rows) {
  auto& [a, b, c, d] = rows;
  const auto ab0 = __builtin_shufflevector(a.pack, b.pack, 0, 8, 2, 10, 4, 12, 6, 14);
  const auto ab1 = __builtin_shufflevector(a.pack, b.pack, 1, 9, 3, 11, 5, 13, 7, 15);
  const auto cd0 = __builtin_shufflevector(c.pack, d.pack, 0, 8, 2, 10, 4, 12, 6, 14);
  const auto cd1 = __builtin_shufflevector(c.pack, d.pack, 1, 9, 3, 11, 5, 13, 7, 15);
  a.pack = __builtin_shufflevector(ab0, cd0, 0, 1, 8, 9, 4, 5, 12, 13);
  b.pack = __builtin_shufflevector(ab1, cd1, 0, 1, 8, 9, 4, 5, 12, 13);
  c.pack = __builtin_shufflevector(ab0, cd0, 2, 3, 10, 11, 6, 7, 14, 15);
  d.pack = __builtin_shufflevector(ab1, cd1, 2, 3, 10, 11, 6, 7, 14, 15);
}

/// Rows side by side in wide ones, and back.
inline std::array<LanesOf<4>, 4> joined(const std::array<Row, 4>& rows) {
  return rows;
}
inline std::array<LanesOf<8>, 4> joined(const std::array<Row, 8>& rows) {
  std::array<LanesOf<8>, 4> out;
  for (std::size_t k = 0; k < 4; ++k)
    out[k].pack = __builtin_shufflevector(rows[k].pack, rows[k + 4].pack, 0, 1, 2, 3, 4, 5, 6, 7);
  return out;
}
inline std::array<Row, 4> parted(const std::array<LanesOf<4>, 4>& wide) {
  return wide;
}
inline std::array<Row, 8> parted(const std::array<LanesOf<8>, 4>& wide) {
  std::array<Row, 8> out;
  for (std::size_t k = 0; k < 4; ++k) {
    out[k].pack = __builtin_shufflevector(wide[k].pack, wide[k].pack, 0, 1, 2, 3);
    out[k + 4].pack = __builtin_shufflevector(wide[k].pack, wide[k].pack, 4, 5, 6, 7);
  }
  return out;
}

}  // namespace lanes_detail

/// Turns a row for each lane into four columns, and back.
inline Columns columns_of(const Rows& rows) {
  Columns columns = lanes_detail::joined(rows);
  lanes_detail::transpose(columns);
  return columns;
}
inline Rows rows_of(Columns columns) {
  lanes_detail::transpose(columns);
  return lanes_detail::parted(columns);
}

/// Vectors that lie one behind the other, one in each lane; and back.
inline Vec3Of<Lanes> load_vectors(const Vec3* from) {
  const double* f = from->data();
  Rows rows;
  for (std::size_t k = 0; k + 1 < rows.size(); ++k) rows[k] = Row::load(f + 3 * k);
  // The last is read from one place before its start: nothing behind the array is touched.
  const Row last = Row::load(f + 3 * (rows.size() - 1) - 1);
  rows.back() = Row::Pack(__builtin_shufflevector(last.pack, last.pack, 1, 2, 3, 0));
  const Columns c = columns_of(rows);
  return {c[0], c[1], c[2]};
}
inline void store_vectors(const Vec3Of<Lanes>& v, Vec3* to) {
  const Rows rows = rows_of({v.x(), v.y(), v.z(), Lanes(0.0)});
  double* t = to->data();
  // Each is written over the surplus number of the one before it.
  for (std::size_t k = 0; k + 1 < rows.size(); ++k) rows[k].store(t + 3 * k);
  for (int k = 0; k < 3; ++k) t[3 * (Lanes::size - 1) + k] = rows.back()[k];
}

}  // namespace trackbed
