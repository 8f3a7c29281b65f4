// A railway coach in the vertical plane: car body and two bogies that bounce and pitch, four wheelsets that
// bounce. All values of one half (one rail) of the vehicle.
#pragma once

#include <array>

#include "fem/implicit_part.h"

namespace trackbed::fem {

struct Suspension {
  double stiffness = 0;  // [N/m]
  double damping = 0;    // [N s/m]
};

struct Vehicle {
  double car_mass = 0, car_pitch_inertia = 0;      // [kg], [kg m^2]
  double bogie_mass = 0, bogie_pitch_inertia = 0;  // of one bogie
  double wheelset_mass = 0;                        // of one wheelset
  double bogie_distance = 0;                       // between the bogies' centres [m]
  double wheelbase = 0;                            // between a bogie's axles [m]
  Suspension primary;                              // at one wheel
  Suspension secondary;                            // at one bogie
  double secondary_bending = 0;                    // car against bogie, of pitch [N m/rad]

  /// From the front: of each wheelset behind the first [m].
  std::array<double, 4> wheel_offsets() const {
    return {0, wheelbase, bogie_distance, bogie_distance + wheelbase};
  }
  double weight(double gravity) const { return (car_mass + 2 * bogie_mass + 4 * wheelset_mass) * gravity; }
};

/// Coordinates: car z, pitch; front bogie z, pitch; rear bogie z, pitch; wheelsets z from the front. Pitch is
/// positive when the front rises. Ports: the wheelsets' z.
Structure<MatrixXd> vehicle_structure(const Vehicle& vehicle, double gravity);

}  // namespace trackbed::fem
