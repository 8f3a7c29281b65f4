// Quantities with units, at the edges of the program. Inside, every number is SI.
#pragma once

#include <string>
#include <string_view>
#include <variant>

namespace trackbed {

/// What a number measures. The SI unit of each stands beside it.
enum class Dimension {
  none,               // -
  length,             // m
  area,               // m^2
  volume,             // m^3
  time,               // s
  frequency,          // Hz
  velocity,           // m/s
  acceleration,       // m/s^2
  angle,              // rad
  angular_velocity,   // rad/s
  mass,               // kg
  density,            // kg/m^3
  force,              // N
  moment,             // N m
  stress,             // Pa
  stiffness,          // N/m
  energy,             // J
};

std::string_view name_of(Dimension dimension);     ///< "length"
std::string_view si_unit_of(Dimension dimension);  ///< "m"; "-" for none

/// Reads "300 mm", "20 kN", "2630 kg/m^3", "5 Hz", "30 deg".
/// Returns the value in SI, or a sentence saying what is wrong and which units would do.
std::variant<double, std::string> parse_quantity(std::string_view text, Dimension dimension);

/// Shortest text that reads back to the same number, with the SI unit: "0.3 m".
std::string to_text(double si_value, Dimension dimension);

}  // namespace trackbed
