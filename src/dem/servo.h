// A wall that presses with a given force.
#pragma once

#include "dem/model.h"
#include "dem/state.h"

namespace trackbed {

/// Stiffness of all touching contacts of a wall against its motion along `direction` (unit vector) [N/m].
double stiffness_along(const Model& model, const State& state, int wall, const Vec3& direction);

/// Speed [m/s] along `direction` that brings the force of the wall on the stones to `target` [N]: in each
/// step the share 0.8 of the missing force through the contacts' own stiffness (the servo of PFC, whose error
/// shrinks to a fifth each step on stones that do not move), so there is no gain to tune. Without contact the
/// wall comes no faster than lets its impact on the heaviest stone reach a twentieth of the target.
double servo_speed(const Model& model, const State& state, int wall, const Vec3& direction, double target);

}  // namespace trackbed
