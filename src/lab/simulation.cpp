#include "lab/simulation.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "base/error.h"
#include "base/runs.h"

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

const StoneSet& Simulation::stone_set(std::string_view name) const {
  const auto found = std::ranges::find(stone_sets, name, &StoneSet::name);
  if (found == stone_sets.end()) throw RunError(fmt::format("there is no set of stones called {}", name));
  return *found;
}

void Simulation::drive(std::size_t wall, const Vec3& velocity) {
  WallState& w = state.walls[wall];
  const auto& body = model.walls[wall].body;
  for (int a = 0; a < 3; ++a) {
    if (!keeps_velocity(model.walls[wall], w, a)) continue;
    if (body)
      w.boundary_work += 0.5 * body->mass * (velocity[a] * velocity[a] - w.velocity[a] * w.velocity[a]);
    w.velocity[a] = velocity[a];
  }
  const auto number = static_cast<int>(wall);
  const bool is_of_container = number == container_mesh ||
                               std::ranges::find(trays, number, &Tray::wall) != trays.end() ||
                               std::ranges::find(sides, number, &BoxSide::wall) != sides.end();
  if (is_of_container && !model.domain.isEmpty())
    model.domain.extend(container.translated(w.pose.position - wall_reference[wall].position));
}

void Simulation::stop_stones() {
  for_each_by_runs(state.clumps.id.size(), [&](std::size_t c) {
    set_motion(state, static_cast<int>(c), Vec3::Zero(), Vec3::Zero());
  });
}

void Simulation::restore(const Conditions& before) {
  const bool was_scaled = model.scaled_share > 0;
  static_cast<Conditions&>(model) = before;
  if (!was_scaled || model.scaled_share > 0) return;
  stop_stones();
  const Clumps& c = state.clumps;
  for (int k = 0; k < c.size(); ++k) {
    const auto i = static_cast<std::size_t>(k);
    if (c.inertial_mass[i] != c.mass[i]) unscale_inertia(model, state, k);
  }
  changed();
}

StonePlaces places_of(const State& state) {
  StonePlaces places;
  for (std::size_t i = 0; i < state.clumps.id.size(); ++i)
    places[state.clumps.id[i]] = state.clumps.position[i];
  return places;
}

std::vector<Vec3> displacements(const State& state, const StonePlaces& before) {
  const Clumps& c = state.clumps;
  std::vector<Vec3> all(c.id.size(), Vec3::Zero());
  for (std::size_t i = 0; i < all.size(); ++i)
    if (const auto old = before.find(c.id[i]); old != before.end()) all[i] = c.position[i] - old->second;
  return all;
}

int add_wall(Simulation& sim, Wall wall, const Pose& pose) {
  sim.model.walls.push_back(std::move(wall));
  sim.state.walls.emplace_back();
  sim.state.walls.back().pose = pose;
  sim.wall_reference.push_back(pose);
  return static_cast<int>(sim.model.walls.size()) - 1;
}

}  // namespace trackbed
