// What a number of repeats tell together.
#pragma once

#include <vector>

namespace trackbed {

/// Of repeats that differ by chance alone.
struct Estimate {
  int n = 0;
  double mean = 0;
  double deviation = 0;   // standard deviation of one repeat, n - 1 in the denominator; NaN for n < 2
  double half_width = 0;  // the mean lies within mean +- half_width with a probability of 95 %; NaN for n < 2

  double low() const { return mean - half_width; }
  double high() const { return mean + half_width; }
  /// Half width over the size of the mean; infinite when nothing is known, 0 when all values are the same.
  double relative_width() const;
};

/// Student's interval: half_width = t(0.975, n - 1) deviation / sqrt(n). Values that are not numbers are left
/// out.
Estimate estimate(const std::vector<double>& values);

/// A straight line y = intercept + slope x through n points by least squares, the y with errors that are
/// independent, normal and equally large. Half widths are of the 95 % intervals of each alone; NaN for n < 3.
struct LineFit {
  int n = 0;
  double intercept = 0, slope = 0;  // NaN for n < 2 or when all x are the same
  double intercept_half_width = 0, slope_half_width = 0;
  double r_squared = 0;  // 1 - squares of the residuals / squares about the mean; NaN when all y are the same
};

/// With t = t(0.975, n - 2), s^2 = squares of the residuals / (n - 2) and S = sum of (x - mean)^2: half
/// widths t s/sqrt(S) of the slope and t s sqrt(1/n + mean^2/S) of the intercept (Draper & Smith, Applied
/// Regression Analysis, ch. 1). Points with a value that is not a number are left out.
LineFit fit_line(const std::vector<double>& x, const std::vector<double>& y);

}  // namespace trackbed
