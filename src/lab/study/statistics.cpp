#include "lab/study/statistics.h"

#include <boost/math/distributions/students_t.hpp>
#include <cmath>
#include <limits>

namespace trackbed {

double Estimate::relative_width() const {
  if (half_width == 0) return 0;
  if (n < 2 || mean == 0) return std::numeric_limits<double>::infinity();
  return half_width / std::abs(mean);
}

Estimate estimate(const std::vector<double>& values) {
  constexpr double unknown = std::numeric_limits<double>::quiet_NaN();
  Estimate e;
  double sum = 0;
  for (double v : values) {
    if (std::isnan(v)) continue;
    sum += v;
    ++e.n;
  }
  e.mean = e.n > 0 ? sum / e.n : unknown;
  e.deviation = e.half_width = unknown;
  if (e.n < 2) return e;
  double squares = 0;
  for (double v : values)
    if (!std::isnan(v)) squares += (v - e.mean) * (v - e.mean);
  e.deviation = std::sqrt(squares / (e.n - 1));
  const boost::math::students_t t(e.n - 1);
  e.half_width = boost::math::quantile(t, 0.975) * e.deviation / std::sqrt(e.n);
  return e;
}

}  // namespace trackbed
