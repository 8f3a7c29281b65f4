#include <algorithm>
#include <array>
#include <cmath>
#include <string_view>
#include <tuple>

#include "dem/touching.h"
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

/// The parts of a body that stones press on, by where the normals of their contacts point.
enum class Face { base, sides, ends };

/// The longer of a body's two horizontal axes, 0 or 1, in its own frame: that of a sleeper.
int long_axis(const WallShape& shape) {
  Eigen::AlignedBox3d box;
  for (const Vec3& v : shape.mesh.vertices) box.extend(v);
  return box.sizes().x() >= box.sizes().y() ? 0 : 1;
}

/// Which face a contact with this normal (body frame) presses on: that of the largest part of the normal.
Face face_of(const Vec3& normal, int along) {
  Eigen::Index axis = 0;
  normal.cwiseAbs().maxCoeff(&axis);
  if (axis == 2) return Face::base;
  return axis == along ? Face::ends : Face::sides;
}

/// Contacts of the stones with one wall or body.
template <class Visit>
void visit_wall(const Simulation& sim, std::size_t wall, Visit&& visit) {
  for (const WallBlock& block : sim.state.wall_blocks)
    for (const WallPair& pair : block.pairs)
      if (pair.wall == static_cast<int>(wall)) visit_pair(sim.model, sim.state, block, pair, visit);
}

/// Number and magnitudes of the elastic contact forces on a wall or body.
struct WallContacts {
  int number = 0;
  double sum = 0, largest = 0;  // [N]
  double mean() const { return number > 0 ? sum / number : 0; }
};

WallContacts contacts_of_wall(const Simulation& sim, std::size_t wall) {
  WallContacts found;
  visit_wall(sim, wall, [&](const Touching& t) {
    const double force = t.force().norm();
    ++found.number;
    found.sum += force;
    found.largest = std::max(found.largest, force);
  });
  return found;
}

/// Elastic force of the stones on one face of a body [N].
Vec3 force_on_face(const Simulation& sim, std::size_t wall, Face face) {
  const int along = long_axis(sim.model.walls[wall].shape);
  const Quat back = sim.state.walls[wall].pose.orientation.conjugate();
  Vec3 force = Vec3::Zero();
  visit_wall(sim, wall, [&](const Touching& t) {
    if (face_of(back * t.normal, along) == face) force += t.force();
  });
  return force;
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
  all.push_back({name + ".contacts", Dimension::none, "touches of pebbles with " + name,
                 [index](const Simulation& sim) { return contacts_of_wall(sim, index).number; }});
  all.push_back({name + ".contact_force_mean", Dimension::force,
                 "magnitude of the elastic contact force on " + name + ", mean of its contacts",
                 [index](const Simulation& sim) { return contacts_of_wall(sim, index).mean(); }});
  all.push_back({name + ".contact_force_max", Dimension::force,
                 "magnitude of the largest elastic contact force on " + name,
                 [index](const Simulation& sim) { return contacts_of_wall(sim, index).largest; }});
  if (wall.body)
    for (const auto& [face, part, where] : {std::tuple(Face::base, "base", "its underside and top"),
                                            {Face::sides, "sides", "its long sides"},
                                            {Face::ends, "ends", "its ends"}})
      add_vector(all, name + ".force_" + part, Dimension::force,
                 "of the stones on " + name + " whose contacts face " + where,
                 [index, face = face](const Simulation& sim) { return force_on_face(sim, index, face); });
  if (wall.body)
    add_vector(all, name + ".applied_force", Dimension::force,
               "on " + name + ", apart from stones and gravity",
               [state](const Simulation& sim) { return state(sim).applied_force; });
  return all;
}

}  // namespace trackbed
