// A wall is a wall however it is cut into triangles.
#include <gtest/gtest.h>

#include <cmath>

#include "scenes/scene.h"

namespace trackbed {
namespace {

using scenes::Setting;

Setting frictional() {
  Setting a;
  a.friction = 0.3;
  a.gravity = {0, 0, -9.81};
  a.dt = 0.1 * scenes::contact_time_scale(a);
  return a;
}

enum class Cut { plane, two, many, tee };

void add_floor(Simulation& sim, Cut cut) {
  switch (cut) {
    case Cut::plane:
      scenes::add_plane(sim, Vec3::Zero(), Vec3::UnitZ());
      return;
    case Cut::two:
      scenes::add_plate(sim, scenes::plate(-0.3, 0.7, -0.4, 0.4, 0, 1, 1));
      return;
    case Cut::many:
      scenes::add_plate(sim, scenes::plate(-0.3, 0.7, -0.4, 0.4, 0, 40, 32));
      return;
    case Cut::tee: {
      // One large triangle on each side of x = 0.05; on the other side, corners in the middle of its edge.
      TriangleMesh mesh = scenes::plate(0.05, 0.7, -0.4, 0.4, 0, 3, 7);
      const int n = static_cast<int>(mesh.vertices.size());
      mesh.vertices.insert(mesh.vertices.end(), {{0.05, -0.4, 0}, {0.05, 0.4, 0}, {-0.9, 0, 0}});
      mesh.facets.push_back({n, n + 1, n + 2});
      scenes::add_plate(sim, mesh);
    }
  }
}

struct Path {
  std::vector<Vec3> places, forces;
};

Path path(Cut cut, bool is_clump, const Vec3& velocity, double height) {
  Simulation sim = scenes::make_scene(frictional());
  sim.model.templates.push_back(make_clump_template(
      "pair", {{{-0.01, 0, 0}, 0.012}, {{0.01, 0.002, 0}, 0.012}}, 2e-5, {1e-9, 2e-9, 2.2e-9}));
  sim.model.time_step.fixed = 1e-5;
  add_floor(sim, cut);
  scenes::add_ball(sim, {0, 0, (is_clump ? 0.012 : 0.02) + height}, velocity, Vec3::Zero(), 1,
                   is_clump ? 1 : 0);
  Path p;
  // A clump that slides chatters, and rounding grows tenfold each 2 ms: compared while it is still small.
  const int steps = is_clump && velocity.norm() > 0 ? 2000 : 8000;
  for (int k = 0; k < steps; ++k) {
    sim.step();
    if (k % 20 == 0) {
      p.places.push_back(sim.state.clumps.position[0]);
      p.forces.push_back(sim.state.walls[0].force);
    }
  }
  return p;
}

TEST(walls, path_does_not_depend_on_the_triangles) {
  const struct {
    bool is_clump;
    Vec3 velocity;
    double height;
  } cases[] = {{false, {0, 0, 0}, -8e-7},
               {true, {0, 0, 0}, -1e-7},
               {false, {1, 0.3, 0}, -8e-7},
               {true, {1, 0.3, 0}, 0},
               {false, {1, 0.2, -1}, 1e-3}};
  for (const auto& c : cases) {
    const Path plane = path(Cut::plane, c.is_clump, c.velocity, c.height);
    double largest = 0;
    for (const Vec3& f : plane.forces) largest = std::max(largest, f.norm());
    ASSERT_GT(largest, 0);
    for (Cut cut : {Cut::two, Cut::many, Cut::tee}) {
      const Path p = path(cut, c.is_clump, c.velocity, c.height);
      double away = 0, force = 0;
      for (std::size_t k = 0; k < p.places.size(); ++k) {
        away = std::max(away, (p.places[k] - plane.places[k]).norm());
        force = std::max(force, (p.forces[k] - plane.forces[k]).norm());
      }
      EXPECT_LT(away, 1e-9) << static_cast<int>(cut) << " " << c.is_clump;
      EXPECT_LT(force / largest, 1e-7) << static_cast<int>(cut) << " " << c.is_clump;
    }
  }
}

int contacts(const TriangleMesh& mesh, const Vec3& centre, const Quat& turn, bool in_float) {
  Simulation sim = scenes::make_scene({});
  sim.model.limits.overlap = 1;
  TriangleMesh turned = mesh;
  for (Vec3& v : turned.vertices) {
    v = turn * v + Vec3(1, 2, 3);
    if (in_float) v = v.cast<float>().cast<double>();
  }
  scenes::add_plate(sim, turned);
  scenes::add_ball(sim, turn * centre + Vec3(1, 2, 3));
  sim.changed();
  return sim.work.touching;
}

TEST(walls, corners_edges_and_tips) {
  const TriangleMesh box = box_mesh(Vec3::Constant(0.2));
  const double r = 0.02 - 1e-4;
  const TriangleMesh pyramid{
      {{0, 0, 0}, {0.1, 0.1, -0.1}, {-0.1, 0.1, -0.1}, {-0.1, -0.1, -0.1}, {0.1, -0.1, -0.1}},
      {{0, 1, 2}, {0, 2, 3}, {0, 3, 4}, {0, 4, 1}}};
  const double diagonal = r / std::sqrt(2.0);
  for (const Quat& turn : {Quat::Identity(), Quat(0.5, -0.3, 0.7, 0.2).normalized()})
    for (bool in_float : {false, true}) {
      EXPECT_EQ(contacts(box, {0.1, 0.1, r}, turn, in_float), 1);  // inside, on a face's diagonal
      EXPECT_EQ(contacts(box, {r, 0.1, r}, turn, in_float), 2);    // inside, along an edge
      EXPECT_EQ(contacts(box, {r, r, r}, turn, in_float), 3);      // inside, in a corner
      EXPECT_EQ(contacts(box, {-diagonal, 0.1, -diagonal}, turn, in_float), 1);  // outside, on an edge
      EXPECT_EQ(contacts(box, Vec3::Constant(-r / std::sqrt(3.0)), turn, in_float),
                1);  // outside, on a corner
      EXPECT_EQ(contacts(pyramid, {0, 0, r}, turn, in_float), 1);
    }
}

// Over the seam of two facets that a mesh in single precision leaves a hair concave, both facets gave the
// contact to the other, and there was none.
TEST(walls, no_hole_over_a_seam_that_is_almost_flat) {
  for (double lean : {1e-6, 5e-6, 1.2e-5, 1.5e-5, 1.9e-5, 3e-5, 1e-4}) {
    const TriangleMesh fold{{{0, -0.1, 0}, {0, 0.1, 0}, {0.1, 0, 0.1 * lean}, {-0.1, 0, 0.1 * lean}},
                            {{0, 2, 1}, {0, 1, 3}}};
    EXPECT_EQ(contacts(fold, {0, 0, 0.0199}, Quat::Identity(), false), 1) << lean;
  }
}

// A pebble that meets more facets than are looked at must see the nearest ones, wherever they stand in the
// list.
TEST(walls, mesh_far_finer_than_the_pebble) {
  EXPECT_EQ(contacts(scenes::plate(-0.02, 0.02, -0.02, 0.02, 0, 40, 40), {0.0003, 0.0004, 0.019},
                     Quat::Identity(), false),
            1);
  Simulation sim = scenes::make_scene({});
  sim.model.limits.overlap = 1;
  const int wall = scenes::add_plate(sim, scenes::plate(-0.02, 0.02, -0.02, 0.02, 0, 40, 40));
  scenes::add_ball(sim, {0.0003, 0.0004, 0.019});
  sim.changed();
  EXPECT_NEAR(sim.state.walls[static_cast<std::size_t>(wall)].force.z(), -1e6 * 0.001, 1e-6);
}

}  // namespace
}  // namespace trackbed
