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

}  // namespace trackbed
