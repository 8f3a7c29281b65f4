// All that changes, and nothing that can be worked out again: what a checkpoint holds. Each part tells its
// members once for being written and read back (base/archive.h).
//
// Conventions: SI, world axes. Positions, orientations, forces and moments belong to time t; velocities and
// angular momenta to t - dt/2 (leapfrog), until the first step, when they are those of the start.
#pragma once

#include <cstdint>
#include <vector>

#include "base/vec.h"
#include "dem/contact.h"
#include "dem/model.h"

namespace trackbed {

/// Energy each stone has turned into heat since the start [J]; a contact's loss is booked on its body 1.
struct StoneLosses : Losses {
  double damping = 0;
  template <class A>
  void archive(A& a) {
    a(friction, rolling, dashpot, damping);
  }
};

/// The stones, one entry a clump in each array.
struct Clumps {
  int next_id = 0;         // of the stone that is added next: no two stones ever share one
  std::vector<int> id;     // stays with the stone
  std::vector<int> shape;  // index into Model::templates
  std::vector<int> material;
  std::vector<double> scale;           // on the template's lengths
  std::vector<double> mass;            // that weighs [kg]
  std::vector<double> inertial_mass;   // that resists: the same, but where the time step is scaled [kg]
  std::vector<Vec3> inertia;           // principal, of the inertial mass [kg m^2]
  std::vector<Vec3> position;          // centre of mass [m]
  std::vector<Quat> orientation;       // principal axes to world
  std::vector<Vec3> velocity;          // [m/s]
  std::vector<Vec3> angular_momentum;  // [kg m^2/s]
  std::vector<Vec3> angular_velocity;  // that goes with it [rad/s]
  std::vector<Vec3> force;             // of contacts, without gravity [N]
  std::vector<Vec3> moment;            // about the centre of mass [N m]
  std::vector<StoneLosses> losses;

  int size() const { return static_cast<int>(id.size()); }
  template <class A>
  void archive(A& a) {
    a(next_id, id, shape, material, scale, mass, inertial_mass, inertia, position, orientation, velocity,
      angular_momentum, angular_velocity, force, moment, losses);
  }
};

/// Motion and reaction of a wall or body; for a body the frame's origin is its centre of mass.
struct WallState {
  bool present = true;  // false: a body that no stage has placed yet, or a wall that was taken away
  bool held = false;    // a body that keeps its velocity whatever acts on it, as walls do
  Pose pose;
  Vec3 velocity = Vec3::Zero();          // [m/s]
  Vec3 angular_velocity = Vec3::Zero();  // about the frame's origin [rad/s]
  Vec3 angular_momentum = Vec3::Zero();  // bodies only [kg m^2/s]
  Vec3 force = Vec3::Zero();             // of the stones on the wall [N]
  Vec3 moment = Vec3::Zero();            // of the stones about the frame's origin [N m]
  Vec3 applied_force = Vec3::Zero();     // on a body [N]
  Vec3 applied_moment = Vec3::Zero();    // on a body [N m]
  double applied_work = 0;               // of the applied force and moment on a body [J]
  double boundary_work = 0;              // that a moved wall did on the stones [J]
  double damping_loss = 0;               // bodies [J]

  template <class A>
  void archive(A& a) {
    a(present, held, pose, velocity, angular_velocity, angular_momentum, force, moment, applied_force,
      applied_moment, applied_work, boundary_work, damping_loss);
  }
};

/// Two pebbles of a clump pair, by their place in the templates.
struct PebblePair {
  std::int32_t a, b;
  template <class A>
  void archive(A& archive) {
    archive(a, b);
  }
};

/// Clumps i < j that lie near each other; their candidates are [first, first + count) of the block.
struct ClumpPair {
  int i, j;
  int first, count;
  template <class A>
  void archive(A& a) {
    a(i, j, first, count);
  }
};

/// Consecutive clump pairs that one thread works on at a time, all pairs of one i in the same block.
/// Candidates out of touch have an untouched memory and mean nothing: which they are depends on when a search
/// ran.
struct PairBlock {
  static constexpr int full = 96;  // no further clump's pairs are added to as many
  std::vector<ClumpPair> pairs;
  std::vector<PebblePair> keys;
  std::vector<ContactMemory> memory;
  template <class A>
  void archive(A& a) {
    a(pairs, keys, memory);
  }
};

/// The places where one pebble touches one wall.
struct WallMemory {
  std::array<ContactMemory, max_wall_points> points;
  template <class A>
  void archive(A& a) {
    a(points);
  }
};

/// A clump near a wall; candidates are pebbles.
struct WallPair {
  int clump, wall;
  int first, count;
  template <class A>
  void archive(A& a) {
    a(clump, wall, first, count);
  }
};

/// Consecutive pairs of clumps with one wall that one thread works on at a time.
struct WallBlock {
  static constexpr int full = 16;   // no further group's pairs are added to as many
  static constexpr int group = 64;  // clumps with consecutive numbers, whose effect on a wall is one sum
  std::vector<WallPair> pairs;
  std::vector<std::int32_t> keys;  // pebble
  std::vector<WallMemory> memory;
  template <class A>
  void archive(A& a) {
    a(pairs, keys, memory);
  }
};

struct State {
  Clumps clumps;
  std::vector<WallState> walls;
  std::vector<PairBlock> pair_blocks;  // pairs ascending by (i, j) through all blocks
  std::vector<WallBlock> wall_blocks;  // pairs ascending by (wall, clump) through all blocks
  double time = 0;                     // [s]
  double dt = 0;                       // of the last step [s]; 0 before the first
  double planned_dt = 0;               // of the next [s]; 0: to be found
  std::int64_t step = 0;
  std::int64_t next_look = 0;  // step after which the state is inspected and the step planned anew

  template <class A>
  void archive(A& a) {
    a(clumps, walls, pair_blocks, wall_blocks, time, dt, planned_dt, step, next_look);
  }
};

/// Whether a wall or body keeps its velocity along a world axis whatever acts on it: walls, held bodies, and
/// bodies along their blocked axes.
inline bool keeps_velocity(const Wall& wall, const WallState& state, int axis) {
  return !wall.body || state.held || !wall.body->free_shift[static_cast<std::size_t>(axis)];
}

/// Volume of a stone [m^3].
double volume_of(const Model& model, const Clumps& clumps, std::size_t clump);

/// Radius of the ball, or the disc, of that volume [m].
double equal_volume_radius(const Model& model, const Clumps& clumps, std::size_t clump);
/// That of each stone: contacts are more than stones, and each would ask twice.
std::vector<double> equal_volume_radii(const Model& model, const Clumps& clumps);

/// Adds a stone at rest; returns its index. Mass is density x volume.
int add_clump(const Model& model, State& state, int shape, double scale, int material, const Pose& pose);

/// Sets the velocity [m/s] and angular velocity [rad/s] of a stone.
void set_motion(State& state, int clump, const Vec3& velocity, const Vec3& angular_velocity);

/// Multiplies a stone's size by `factor` about its centre; mass and inertia follow.
void rescale(const Model& model, State& state, int clump, double factor);

/// What becomes of a stone that stays where it is.
struct Reshaped {
  int clump;
  int shape;  // index into Model::templates
  double scale;
  int material;
  Quat orientation;
};

/// Gives stones another shape, size, material and orientation about the same centre, and the motion they had.
/// The memory of their contacts is let go of.
void reshape(const Model& model, State& state, const std::vector<Reshaped>& stones);

/// Multiplies what resists the motion of a stone, but not its weight, by `factor`. It keeps its momentum when
/// that grows, its speed when it falls, and what kinetic energy this takes is booked as damped.
void scale_inertia(State& state, int clump, double factor);

/// Gives a stone the inertia of its mass again, to the last bit.
void unscale_inertia(const Model& model, State& state, int clump);

/// Removes stones (indices ascending) and the memory of their contacts; the others keep their order.
void remove_clumps(State& state, const std::vector<int>& clumps);

/// Fingerprint of everything that bears on the future: equal only for states that go on alike, bit for bit.
std::uint64_t hash(const State& state);

}  // namespace trackbed
