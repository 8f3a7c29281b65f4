#include "lab/simulation.h"

#include <utility>

namespace trackbed {

int Simulation::find_wall(std::string_view name) const {
  for (std::size_t w = 0; w < model.walls.size(); ++w)
    if (model.walls[w].shape.name == name) return static_cast<int>(w);
  return -1;
}

int Simulation::find_material(std::string_view name) const {
  for (std::size_t m = 0; m < model.materials.size(); ++m)
    if (model.materials[m].name == name) return static_cast<int>(m);
  return -1;
}

int add_wall(Simulation& sim, Wall wall, const Pose& pose) {
  sim.model.walls.push_back(std::move(wall));
  sim.state.walls.emplace_back();
  sim.state.walls.back().pose = pose;
  sim.wall_reference.push_back(pose);
  return static_cast<int>(sim.model.walls.size()) - 1;
}

}  // namespace trackbed
