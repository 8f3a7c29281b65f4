// How a bed bears a sleeper: a law for the track out of what was recorded while it was pressed.
#pragma once

#include <filesystem>
#include <optional>
#include <vector>

#include "fem/link_law.h"

namespace trackbed {

/// Sinking [m] and force [N] of a whole sleeper, one after the other in time.
struct PressHistory {
  std::vector<double> sinking, force;
};

/// First loading from no force, unloading along a constant slope; of a whole sleeper.
struct SupportCurve {
  std::vector<double> sinking, force;  // ascending, from (0, 0) [m], [N]
  double unloading = 0;                // [N/m], at least the steepest slope of the curve
  double settlement = 0;               // for good, before this loading began [m]

  /// Force over sinking at its end [N/m].
  double secant() const { return force.back() / sinking.back(); }
};

/// The curve of the last rise to the largest force, from the last touch without force, by its crossings of
/// `points` equal steps of force. The slope of unloading is that from the largest force to half of it after
/// the rise, or, without unloading or where that is softer, the steepest slope of the curve. A rise that
/// begins under a force is led back to none with this slope, and so is the first touch, from which the
/// settlement counts. Throws InputError with a sentence when the force never grows above zero or the sleeper
/// does not sink.
SupportCurve support_curve(const PressHistory& history, int points = 20);

/// The same from a CSV with columns sinking and force. Throws InputError that names the file.
SupportCurve read_support_curve(const std::filesystem::path& file);
void write_history(const PressHistory& history, const std::filesystem::path& file);

/// Law of the half of a sleeper.
fem::MeasuredSupport half_of(const SupportCurve& curve);

/// The history of a whole sleeper of which the bed bore a share, on something below the bed that gives with a
/// stiffness [N/m] for the whole sleeper; without stiffness it does not give.
PressHistory of_whole_sleeper(PressHistory history, double share, std::optional<double> below);

}  // namespace trackbed
