#include <algorithm>
#include <array>
#include <string_view>
#include <tuple>
#include <vector>

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

/// The parts of a body that stones press on.
enum class Face { base, slopes, sides, ends };

/// A facet's direction and what part of the body it belongs to.
struct Facing {
  Vec3 outwards;  // in the body's frame
  Face face;
};

/// Facets of a body by where they face as it was placed; its ends are where it is longest.
std::vector<Facing> facings_of(const Simulation& sim, std::size_t wall) {
  constexpr double level = 0.02;  // sine of about a degree
  const TriangleMesh& mesh = sim.model.walls[wall].shape.mesh;
  const Quat& placed = sim.wall_reference[wall].orientation;
  Eigen::AlignedBox3d box;
  for (const Vec3& v : mesh.vertices) box.extend(placed * v);
  const Eigen::Index along = box.sizes().x() >= box.sizes().y() ? 0 : 1;
  std::vector<Facing> all;
  for (std::size_t f = 0; f < mesh.facets.size(); ++f) {
    const auto [a, b, c] = mesh.corners(f);
    const Vec3 outwards = (b - a).cross(c - a).normalized(), n = (placed * outwards).cwiseAbs();
    Face face = Face::slopes;
    if (n.z() < level) face = n[along] > n[1 - along] ? Face::ends : Face::sides;
    if (n.z() > 1 - level * level) face = Face::base;
    all.push_back({outwards, face});
  }
  return all;
}

/// Which part a contact presses on whose normal (body frame) points into the body: that of the facet which
/// faces it best; a contact on an edge has a normal between those of two facets.
Face face_of(const Vec3& inwards, const std::vector<Facing>& facings) {
  return std::ranges::min_element(facings, {}, [&](const Facing& f) { return f.outwards.dot(inwards); })
      ->face;
}

/// Number and magnitudes of the elastic contact forces on a wall or body.
struct WallContacts {
  int number = 0;
  double sum = 0, largest = 0;  // [N]
  double mean() const { return number > 0 ? sum / number : 0; }
};

WallContacts contacts_of_wall(const Simulation& sim, std::size_t wall) {
  WallContacts found;
  visit_wall(sim.model, sim.state, static_cast<int>(wall), [&](const Touching& t) {
    const double force = t.force().norm();
    ++found.number;
    found.sum += force;
    found.largest = std::max(found.largest, force);
  });
  return found;
}

/// Elastic force of the stones on one part of a body [N].
Vec3 force_on_face(const Simulation& sim, std::size_t wall, Face face) {
  const std::vector<Facing> facings = facings_of(sim, wall);
  const Quat back = sim.state.walls[wall].pose.orientation.conjugate();
  Vec3 force = Vec3::Zero();
  visit_wall(sim.model, sim.state, static_cast<int>(wall), [&](const Touching& t) {
    if (face_of(back * t.normal, facings) == face) force += t.force();
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
    for (const auto& [face, part, where] : {std::tuple(Face::base, "base", "underside and top"),
                                            {Face::slopes, "slopes", "the inclined faces"},
                                            {Face::sides, "sides", "the long sides"},
                                            {Face::ends, "ends", "the ends"}})
      add_vector(all, name + ".force_" + part, Dimension::force,
                 std::string("of the stones on ") + where + " of " + name,
                 [index, face = face](const Simulation& sim) { return force_on_face(sim, index, face); });
  if (wall.body)
    add_vector(all, name + ".applied_force", Dimension::force,
               "on " + name + ", apart from stones and gravity",
               [state](const Simulation& sim) { return state(sim).applied_force; });
  return all;
}

}  // namespace trackbed
