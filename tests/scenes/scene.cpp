#include "scenes/scene.h"

#include <cmath>
#include <numbers>

namespace trackbed::scenes {

Simulation make_scene(const Setting& setting) {
  Simulation sim;
  Model& m = sim.model;
  m.materials = {
      {"stone", 2 * setting.kn, 2 * setting.ks, setting.friction, setting.rolling_friction, setting.density}};
  m.pairs = PairTable(m.materials, setting.law, setting.dashpot);
  m.templates = {make_ball_template(setting.radius)};
  m.gravity = setting.gravity;
  m.local_damping = setting.damping;
  if (setting.dt > 0) {
    m.time_step.fixed = setting.dt;
    m.time_step.largest_travel = 1e6;  // the test chooses its own step
  }
  return sim;
}

int add_ball(Simulation& sim, const Vec3& position, const Vec3& velocity, const Vec3& angular_velocity,
             double scale, int shape) {
  const int ball = add_clump(sim.model, sim.state, shape, scale, 0, {position, Quat::Identity()});
  set_motion(sim.state, ball, velocity, angular_velocity);
  return ball;
}

int add_plane(Simulation& sim, const Vec3& point, const Vec3& normal) {
  const Quat up = Quat::FromTwoVectors(Vec3::UnitZ(), normal);
  return add_wall(sim, {make_plane_wall("plane", 1.0), 0, {}}, {point, up});
}

int add_plate(Simulation& sim, const TriangleMesh& mesh, const Pose& pose) {
  return add_wall(sim, {make_mesh_wall("plate", mesh), 0, {}}, pose);
}

TriangleMesh plate(double x0, double x1, double y0, double y1, double z, int nx, int ny) {
  TriangleMesh mesh;
  for (int j = 0; j <= ny; ++j)
    for (int i = 0; i <= nx; ++i)
      mesh.vertices.emplace_back(x0 + (x1 - x0) * i / nx, y0 + (y1 - y0) * j / ny, z);
  for (int j = 0; j < ny; ++j)
    for (int i = 0; i < nx; ++i) {
      const int a = j * (nx + 1) + i, b = a + 1, c = a + nx + 2, d = a + nx + 1;
      mesh.facets.push_back({a, b, c});
      mesh.facets.push_back({a, c, d});
    }
  return mesh;
}

double contact_time_scale(const Setting& s) {
  const double mass = s.density * 4.0 / 3.0 * std::numbers::pi * s.radius * s.radius * s.radius;
  return std::sqrt(mass / s.kn);
}

int run_until(Simulation& sim, double time, const std::function<bool()>& done) {
  const double end = sim.state.time + time;
  int steps = 0;
  while (sim.state.time < end && !(done && done())) {
    sim.step();
    ++steps;
  }
  return steps;
}

}  // namespace trackbed::scenes
