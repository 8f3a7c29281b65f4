// A model, its state and the names people know them by: what stages act on and measures look at.
#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "dem/inspect.h"
#include "dem/model.h"
#include "dem/numbering.h"
#include "dem/state.h"
#include "dem/step.h"
#include "dem/workspace.h"

namespace trackbed {

/// Of the stones whose inertia a scaled step raises: where graded ballast comes to rest in fewest steps.
inline constexpr double usual_scaled_share = 0.5;

/// Shapes of one kind and their material: what stones are drawn from.
struct StoneSet {
  std::string name;
  int first = 0, count = 0;  // in Model::templates
  int material = 0;
};

/// A wall of thin sides; the insides of all trays together are the container, wherever they have been moved.
struct Tray {
  int wall = 0;
  Eigen::AlignedBox3d inside;  // wall frame [m]
  double rim = 0;              // width of its rim [m]
  double rim_height = 0;       // where that lies, wall frame [m]
};

/// A plane side of the box that is the container, square to an axis.
struct BoxSide {
  int wall = 0, axis = 0;
  bool is_high = false;  // at the high end of the axis
};

/// Tells whether a point [m] lies in a part of space.
using Region = std::function<bool(const Vec3&)>;

/// Where stones were, by their ids [m].
using StonePlaces = std::map<int, Vec3>;
StonePlaces places_of(const State& state);

/// How far each stone has come from there [m]; zero for a stone that was not there.
std::vector<Vec3> displacements(const State& state, const StonePlaces& before);

struct Simulation {
  Model model;
  State state;
  Workspace work;
  std::uint64_t seed = 1;
  Eigen::AlignedBox3d container;  // around the inside of the container [m]; empty: there is none
  int container_mesh = -1;        // the wall whose inside is the container; -1: it is the box, or the trays
  std::vector<Tray> trays;        // none: the container is the box or the mesh
  std::vector<BoxSide> sides;     // of the box
  std::vector<Pose>
      wall_reference;  // where each wall and body stood at the start, or where a stage placed it
  std::string stage;   // name of the one that runs
  StonePlaces places;  // of the stones when it was opened
  std::vector<StoneSet> stone_sets;       // first that of [stones], without a name
  std::map<std::string, Region> regions;  // by the names of the case
  std::vector<double> force_limits;       // of the ranges of force in which contacts are counted [N]

  /// Index of the wall or body of that name; -1 when there is none.
  int find_wall(std::string_view name) const;
  int find_material(std::string_view name) const;
  /// The set of that name, which must be there; "" is that of [stones].
  const StoneSet& stone_set(std::string_view name) const;

  /// Gives a wall or a held body this velocity [m/s], any other body its parts along the blocked axes; the
  /// kinetic energy that a body gains is booked as work of the boundary. The domain grows by where a
  /// wall of the container takes it.
  void drive(std::size_t wall, const Vec3& velocity);

  /// Takes all speed from the stones.
  void stop_stones();

  /// Gives this share of the stones the inertia that a longer time step needs (dem/timestep.h), until
  /// restore().
  void scale_step(double share = usual_scaled_share) { model.scaled_share = share; }

  /// Brings back the conditions of before a stage; all come to a halt when that ends a scaled time step.
  void restore(const Conditions& before);

  void step() { trackbed::step(model, state, work); }

  /// Before many steps with the same stones. What holds their indices must look them up again by their ids.
  void number_by_place() {
    trackbed::number_by_place(state);
    changed();
  }

  /// To be called after the state was changed by hand (stones added, removed, placed).
  void changed() { settle_contacts(model, state, work); }
};

/// Adds a wall at the given pose; returns its index.
int add_wall(Simulation& sim, Wall wall, const Pose& pose);

}  // namespace trackbed
