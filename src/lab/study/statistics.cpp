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

LineFit fit_line(const std::vector<double>& x, const std::vector<double>& y) {
  constexpr double unknown = std::numeric_limits<double>::quiet_NaN();
  LineFit fit;
  const auto over_points = [&](auto&& add) {
    for (std::size_t k = 0; k < x.size(); ++k)
      if (!std::isnan(x[k]) && !std::isnan(y[k])) add(x[k], y[k]);
  };
  double mean_x = 0, mean_y = 0;
  over_points([&](double at, double value) {
    mean_x += at;
    mean_y += value;
    ++fit.n;
  });
  mean_x /= fit.n;
  mean_y /= fit.n;
  double xx = 0, xy = 0, yy = 0, residuals = 0;
  over_points([&](double at, double value) {
    xx += (at - mean_x) * (at - mean_x);
    xy += (at - mean_x) * (value - mean_y);
    yy += (value - mean_y) * (value - mean_y);
  });
  fit.slope = fit.n >= 2 && xx > 0 ? xy / xx : unknown;
  fit.intercept = mean_y - fit.slope * mean_x;
  over_points([&](double at, double value) {
    const double left = value - fit.intercept - fit.slope * at;
    residuals += left * left;
  });
  fit.r_squared = yy > 0 ? 1 - residuals / yy : unknown;
  fit.slope_half_width = fit.intercept_half_width = unknown;
  if (fit.n < 3) return fit;
  const double t = boost::math::quantile(boost::math::students_t(fit.n - 2), 0.975);
  const double s = std::sqrt(residuals / (fit.n - 2));
  fit.slope_half_width = t * s / std::sqrt(xx);
  fit.intercept_half_width = t * s * std::sqrt(1.0 / fit.n + mean_x * mean_x / xx);
  return fit;
}

}  // namespace trackbed
