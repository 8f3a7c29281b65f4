// Small scenes for tests and benchmarks: a few balls or stones, planes, plates, and one law.
#pragma once

#include <functional>
#include <vector>

#include "geom/primitives.h"
#include "lab/simulation.h"

namespace trackbed::scenes {

/// The common data of the verification cases ("set A"): contact stiffness 1e6 N/m (piece stiffness 2e6),
/// radius 20 mm, density 2650, no damping, no gravity unless asked for.
struct Setting {
  double radius = 0.02;       // [m]
  double density = 2650;      // [kg/m^3]
  double kn = 1e6, ks = 1e6;  // of the contact [N/m]
  double friction = 0;
  double rolling_friction = 0;
  LawKind law = LawKind::linear;
  Dashpot dashpot;
  double damping = 0;
  Vec3 gravity = Vec3::Zero();  // [m/s^2]
  double dt = 0;                // fixed step [s]; 0: automatic
};

/// An empty scene: one material, the ball of the setting as template 0.
Simulation make_scene(const Setting& setting);

/// Adds a ball (or stone of template `shape`); returns its index.
int add_ball(Simulation& sim, const Vec3& position, const Vec3& velocity = Vec3::Zero(),
             const Vec3& angular_velocity = Vec3::Zero(), double scale = 1.0, int shape = 0);

/// Adds the plane through `point` with the stones on the side of `normal`; returns the wall's index.
int add_plane(Simulation& sim, const Vec3& point, const Vec3& normal);

/// Adds a fixed wall of triangles; returns its index.
int add_plate(Simulation& sim, const TriangleMesh& mesh, const Pose& pose = {});

/// A rectangle [x0, x1] x [y0, y1] at height z, cut into nx x ny cells of two triangles each, facing up.
TriangleMesh plate(double x0, double x1, double y0, double y1, double z, int nx, int ny);

/// sqrt(m/k) of the setting's ball [s].
double contact_time_scale(const Setting& setting);

/// Steps until `done` or `time` is over; returns the number of steps.
int run_until(Simulation& sim, double time, const std::function<bool()>& done = {});

}  // namespace trackbed::scenes
