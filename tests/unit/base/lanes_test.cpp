#include "base/lanes.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <vector>

namespace trackbed {
namespace {

constexpr int n = Lanes::size;

TEST(Lanes, RowsBecomeColumnsAndBack) {
  Rows rows;
  for (int k = 0; k < n; ++k)
    rows[static_cast<std::size_t>(k)] = row_of({10.0 * k, 10.0 * k + 1, 10.0 * k + 2}, 10.0 * k + 3);
  const Columns columns = columns_of(rows);
  for (int c = 0; c < 4; ++c)
    for (int k = 0; k < n; ++k) EXPECT_EQ(columns[static_cast<std::size_t>(c)][k], 10.0 * k + c);
  const Rows back = rows_of(columns);
  for (std::size_t k = 0; k < rows.size(); ++k)
    for (int c = 0; c < 4; ++c) EXPECT_EQ(back[k][c], rows[k][c]);
}

TEST(Lanes, VectorsAreReadAndWrittenWithoutTheirNeighbours) {
  std::vector<Vec3> v(static_cast<std::size_t>(n) + 2);
  for (std::size_t k = 0; k < v.size(); ++k)
    v[k] = Vec3::Constant(3.0 * static_cast<double>(k)) + Vec3(0, 1, 2);
  const std::vector<Vec3> before = v;
  const Vec3Of<Lanes> read = load_vectors(&v[1]);
  for (int k = 0; k < n; ++k)
    for (int a = 0; a < 3; ++a) EXPECT_EQ(read[a][k], before[static_cast<std::size_t>(k) + 1][a]);
  store_vectors(Vec3Of<Lanes>(-read), &v[1]);
  EXPECT_EQ(v.front(), before.front());
  EXPECT_EQ(v.back(), before.back());
  for (std::size_t k = 1; k + 1 < v.size(); ++k) EXPECT_EQ(v[k], -before[k]);
}

// Every lane has the bits that a double alone would have.
TEST(Lanes, EachDoesWhatADoubleDoes) {
  const Lanes a = each_lane([](std::size_t k) { return 0.1 + static_cast<double>(k); });
  const Lanes b = each_lane([](std::size_t k) { return 3.7 - static_cast<double>(k); });
  const Lanes result = select(a < b, sqrt(a) / b, abs(b) * a - larger(a, b));
  const unsigned less = bits(a < b);
  for (int k = 0; k < n; ++k) {
    const double x = a[k], y = b[k];
    EXPECT_EQ(result[k], x < y ? std::sqrt(x) / y : std::abs(y) * x - std::max(x, y)) << k;
    EXPECT_EQ(less >> k & 1u, x < y ? 1u : 0u) << k;
  }
  EXPECT_EQ(less >> n, 0u);
}

}  // namespace
}  // namespace trackbed
