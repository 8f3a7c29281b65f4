#include <array>
#include <string_view>

#include "lab/measures/measures.h"

namespace trackbed {
namespace {

using Get = std::function<Vec3(const Simulation&)>;

void add_vector(std::vector<Measure>& all, const std::string& name, Dimension dimension,
                const std::string& meaning, const Get& get) {
  constexpr std::array<std::string_view, 3> axes{"x", "y", "z"};
  for (int a = 0; a < 3; ++a)
    all.push_back({name + "_" + std::string(axes[static_cast<std::size_t>(a)]), dimension, meaning,
                   [get, a](const Simulation& sim) { return get(sim)[a]; }});
}

}  // namespace

std::vector<Measure> wall_measures(const Wall& wall, std::size_t index) {
  const std::string& name = wall.shape.name;
  const auto state = [index](const Simulation& sim) -> const WallState& { return sim.state.walls[index]; };
  std::vector<Measure> all;
  add_vector(all, name + ".force", Dimension::force, "of the stones on " + name,
             [state](const Simulation& sim) { return state(sim).force; });
  add_vector(all, name + ".moment", Dimension::moment, "of the stones on " + name + ", about its origin",
             [state](const Simulation& sim) { return state(sim).moment; });
  add_vector(all, name + ".displacement", Dimension::length,
             "of " + name + " from where it stood at the start or was placed",
             [state, index](const Simulation& sim) {
               return Vec3(state(sim).pose.position - sim.wall_reference[index].position);
             });
  add_vector(all, name + ".velocity", Dimension::velocity, "of " + name + ", half a step ago",
             [state](const Simulation& sim) { return state(sim).velocity; });
  if (wall.body)
    add_vector(all, name + ".applied_force", Dimension::force,
               "on " + name + ", apart from stones and gravity",
               [state](const Simulation& sim) { return state(sim).applied_force; });
  return all;
}

}  // namespace trackbed
