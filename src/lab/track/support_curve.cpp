#include "lab/track/support_curve.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "base/error.h"
#include "io/csv.h"

namespace trackbed {
namespace {

using Index = std::size_t;

constexpr double nearly = 0.02;  // of the largest force: a cycle that comes so near has reached it
constexpr double bottom = 0.05;  // of the range of forces: between two rises it falls below
constexpr double touch = 0.002;  // of the largest force: with less a sleeper hardly touches

/// First and last row of the last rise to the largest force.
struct Rise {
  Index from, to;
};

Rise last_rise(const PressHistory& h) {
  const double most = std::ranges::max(h.force), least = std::ranges::min(h.force);
  Index to = h.force.size() - 1;
  while (h.force[to] < (1 - nearly) * most) --to;
  Index from = to;  // the last row before it under little force
  while (from > 0 && h.force[from] > least + bottom * (most - least)) --from;
  Index first = from;  // of the rows under little force
  while (first > 0 && h.force[first - 1] <= least + bottom * (most - least)) --first;
  const auto lowest = std::min_element(h.force.begin() + static_cast<std::ptrdiff_t>(first),
                                       h.force.begin() + static_cast<std::ptrdiff_t>(from) + 1);
  while (h.force[from] > std::max(*lowest, 0.0) + touch * most && from > first) --from;
  to = static_cast<Index>(std::max_element(h.force.begin() + static_cast<std::ptrdiff_t>(from),
                                           h.force.begin() + static_cast<std::ptrdiff_t>(to) + 1) -
                          h.force.begin());
  return {from, to};
}

/// The last row before the sleeper touches the bed for the first time; the first row if it does so already.
Index first_touch(const PressHistory& h) {
  const double most = std::ranges::max(h.force);
  Index k = 0;
  while (h.force[k] <= touch * most) ++k;
  return k > 0 ? k - 1 : 0;
}

/// Where there, led back along a slope, the force is zero.
double first_zero(const PressHistory& h, double slope) {
  const Index k = first_touch(h);
  return h.sinking[k] - std::max(0.0, h.force[k]) / slope;
}

/// Secant from the end of a rise to half of its force; 0 when it is not unloaded so far.
double unloading_slope(const PressHistory& h, Index peak) {
  for (Index k = peak + 1; k < h.force.size(); ++k)
    if (h.force[k] <= 0.5 * h.force[peak]) {
      const double back = h.sinking[peak] - h.sinking[k];
      return back > 0 ? (h.force[peak] - h.force[k]) / back : 0;
    }
  return 0;
}

/// Where a rise first crosses a force, straight between rows.
double crossing(const PressHistory& h, const Rise& rise, double force) {
  Index k = rise.from;
  while (k < rise.to && h.force[k] < force) ++k;
  if (k == rise.from) return h.sinking[k];
  const double share = (force - h.force[k - 1]) / (h.force[k] - h.force[k - 1]);
  return std::lerp(h.sinking[k - 1], h.sinking[k], std::clamp(share, 0.0, 1.0));
}

/// Adds a point; one that lies no deeper than the last takes its place, unless that is the first.
void add(SupportCurve& curve, double sinking, double force) {
  if (!curve.sinking.empty() && sinking <= curve.sinking.back()) {
    if (curve.force.size() > 1) curve.force.back() = force;
    return;
  }
  curve.sinking.push_back(sinking);
  curve.force.push_back(force);
}

double steepest(const SupportCurve& curve) {
  double slope = 0;
  for (Index k = 1; k < curve.force.size(); ++k)
    slope =
        std::max(slope, (curve.force[k] - curve.force[k - 1]) / (curve.sinking[k] - curve.sinking[k - 1]));
  return slope;
}

}  // namespace

SupportCurve support_curve(const PressHistory& h, int points) {
  if (h.force.size() < 2 || std::ranges::max(h.force) <= 0)
    throw InputError("the force on the sleeper never grows above zero");
  const Rise rise = last_rise(h);
  const double most = h.force[rise.to], start = std::max(0.0, h.force[rise.from]);
  SupportCurve curve;
  for (int k = 0; k <= points; ++k) {
    const double force = std::lerp(start, most, static_cast<double>(k) / points);
    add(curve, crossing(h, rise, force), force);
  }
  if (curve.sinking.size() < 2) throw InputError("the sleeper does not sink while the force on it grows");
  curve.unloading = std::max(unloading_slope(h, rise.to), steepest(curve));
  // Led back to no force: counted from there, so that this piece is as steep as unloading to the last bit but
  // one.
  const double begin = curve.sinking.front(), before = start / curve.unloading;
  for (double& sinking : curve.sinking) sinking = (sinking - begin) + before;
  if (start > 0) {
    curve.sinking.insert(curve.sinking.begin(), 0.0);
    curve.force.insert(curve.force.begin(), 0.0);
  }
  curve.settlement = rise.from > first_touch(h) ? begin - before - first_zero(h, curve.unloading) : 0;
  return curve;
}

SupportCurve read_support_curve(const std::filesystem::path& file) {
  const CsvTable table(file);
  try {
    return support_curve(
        {table.numbers("sinking", Dimension::length), table.numbers("force", Dimension::force)});
  } catch (const InputError& error) {
    const std::string what = error.what();
    throw InputError(what.starts_with(file.string()) ? what : fmt::format("{}: {}", file.string(), what));
  }
}

void write_history(const PressHistory& history, const std::filesystem::path& file) {
  CsvWriter table(file, {{"sinking", Dimension::length}, {"force", Dimension::force}});
  for (Index k = 0; k < history.force.size(); ++k) table.add_row({history.sinking[k], history.force[k]});
}

fem::MeasuredSupport half_of(const SupportCurve& curve) {
  fem::MeasuredSupport law{curve.sinking, curve.force, curve.unloading / 2};
  for (double& force : law.force) force /= 2;
  return law;
}

PressHistory of_whole_sleeper(PressHistory history, double share, std::optional<double> below) {
  for (Index k = 0; k < history.force.size(); ++k) {
    history.force[k] /= share;
    if (below) history.sinking[k] += history.force[k] / *below;
  }
  return history;
}

}  // namespace trackbed
