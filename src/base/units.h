// Quantities with units, at the edges of the program. Inside, every number is SI.
#pragma once

#include <string>
#include <string_view>
#include <variant>

namespace trackbed {

/// What a number measures. The SI unit of each stands beside it.
enum class Dimension {
  none,                  // -
  length,                // m
  area,                  // m^2
  volume,                // m^3
  time,                  // s
  frequency,             // Hz
  velocity,              // m/s
  acceleration,          // m/s^2
  angle,                 // rad
  angular_velocity,      // rad/s
  mass,                  // kg
  density,               // kg/m^3
  force,                 // N
  moment,                // N m
  stress,                // Pa
  stiffness,             // N/m
  energy,                // J
  damping,               // N s/m
  rotational_stiffness,  // N m/rad
  second_moment,         // m^4, of an area
  hertz_constant,        // N/m^1.5
};

std::string_view name_of(Dimension dimension);     ///< "length"
std::string_view si_unit_of(Dimension dimension);  ///< "m"; "-" for none

std::string units_of(Dimension dimension);  ///< all that may be written: "N, kN, MN"

/// Reads "300 mm", "20 kN", "2630 kg/m^3", "5 Hz", "30 deg", "1.5 g" (as an acceleration: standard gravity,
/// 9.80665 m/s^2; as a mass: gram). A number without unit is right for `none` only, where "40 %" is too.
/// "m3" and "m³" are the same as "m^3", "N*m" and "N·m" the same as "N m", "µ" is "u".
/// Returns the value in SI, or a sentence saying what is wrong and which units would do.
std::variant<double, std::string> parse_quantity(std::string_view text, Dimension dimension);

/// Shortest text that reads back to the same number, with the SI unit: "0.3 m".
std::string to_text(double value, Dimension dimension);

}  // namespace trackbed
