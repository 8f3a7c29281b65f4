// What stays constant while the stones move. Units SI, z up, forces and normals in world axes unless a name
// ends in _body.
#pragma once

#include <array>
#include <optional>
#include <vector>

#include "base/vec.h"
#include "dem/material.h"
#include "dem/space.h"
#include "dem/wall_shape.h"
#include "geom/clump_template.h"

namespace trackbed {

/// A wall that has mass: it moves under the stones' forces, gravity and an applied force.
struct BodyProperties {
  double mass = 0;              // [kg]
  Vec3 inertia = Vec3::Zero();  // about the axes of the wall frame, which are principal [kg m^2]
  // World axes in which it may move; along the others it keeps the velocity it was given.
  std::array<bool, 3> free_shift{true, true, true};
  std::array<bool, 3> free_turn{true, true, true};  // world axes about which it may turn
};

/// A wall, fixed or moved, or a body such as the sleeper.
struct Wall {
  WallShape shape;
  int material = 0;
  std::optional<BodyProperties> body;
};

/// How the time step is chosen; docs/numerics.md.
struct TimeStepRule {
  double safety = 0.8;           // of sqrt(m/K) for the worst degree of freedom
  double largest_growth = 1.05;  // per step
  double largest_travel = 0.02;  // of the smallest pebble's radius, per step: no contact is jumped into
  std::optional<double> fixed;   // user's choice [s]; refused when above the stable one
  int shortest_interval = 20;    // steps between two looks
  int longest_interval = 100;    // in a bed at rest
};

/// When a run is stopped because its result would be wrong.
struct Limits {
  double overlap = 0.25;  // of the smaller stone's equal-volume radius
  double through =
      0.8;  // of a pebble's radius, into a mesh: past its centre it would come out on the other side
  double speed = 100;  // of any stone [m/s]
  double outside = 0;  // of a stone's centre beyond the domain [m]
  template <class A>
  void archive(A& a) {
    a(overlap, through, speed, outside);
  }
};

/// Speed settings of the contact search; they change no result.
struct SearchRule {
  double skin = 0;    // pebble pairs nearer than this are candidates [m]; 0: chosen from the stones
  double margin = 0;  // stones nearer than this are pairs [m]; 0: chosen from the stones
};

/// What a stage of an experiment may change while it lasts.
struct Conditions {
  Vec3 gravity{0, 0, -9.81};   // [m/s^2]
  double local_damping = 0.7;  // Cundall's coefficient, stones and bodies [-]
  PairTable pairs;
  Limits limits;
  double scaled_share = 0;  // of the stones get more inertia for a longer time step (timestep.h); 0: none
  template <class A>
  void archive(A& a) {
    a(gravity, local_damping, pairs, limits, scaled_share);
  }
};

struct Model : Conditions {
  Space space;
  std::vector<Material> materials;
  std::vector<ClumpTemplate> templates;
  std::vector<Wall> walls;
  Eigen::AlignedBox3d domain;  // no stone's centre leaves it farther than the limit; empty: anywhere
  TimeStepRule time_step;
  SearchRule search;
};

}  // namespace trackbed
