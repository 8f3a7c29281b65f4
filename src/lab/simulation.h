// A model, its state and the names people know them by: what stages act on and measures look at.
#pragma once

#include <cstdint>
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

struct Simulation {
  Model model;
  State state;
  Workspace work;
  std::uint64_t seed = 1;
  Eigen::AlignedBox3d container;  // inside of the container [m]; empty: there is none
  std::vector<Pose>
      wall_reference;  // where each wall and body stood at the start, or where a stage placed it
  std::string stage;   // name of the one that runs

  /// Index of the wall or body of that name; -1 when there is none.
  int find_wall(std::string_view name) const;
  int find_material(std::string_view name) const;

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
