#include "lab/paraview.h"

#include <fmt/format.h>

#include <utility>

#include "io/files.h"
#include "lab/in_touch.h"
#include "lab/shown.h"

namespace trackbed {
namespace {

using Index = std::size_t;

/// One entry for each row: the number of a stone.
std::vector<DataArray> stone_data(const Simulation& sim, const StonePlaces& before,
                                  const std::vector<Index>& rows) {
  const Clumps& c = sim.state.clumps;
  const std::vector<StoneContacts> contacts = contacts_of_stones(sim);
  std::vector<std::int64_t> id, neighbours;
  std::vector<double> speed, diameter, stress;
  std::vector<Vec3> velocity, displacement;
  const std::vector<Vec3> moved = displacements(sim.state, before);
  for (Index i : rows) {
    id.push_back(c.id[i]);
    neighbours.push_back(contacts[i].neighbours);
    speed.push_back(c.velocity[i].norm());
    diameter.push_back(2 * equal_volume_radius(sim, i));
    stress.push_back(contacts[i].mean_stress);
    velocity.push_back(c.velocity[i]);
    displacement.push_back(moved[i]);
  }
  return {{"id", id},
          {"neighbours", neighbours},
          {"speed [m/s]", speed},
          vector_array("velocity [m/s]", velocity),
          vector_array("displacement [m]", displacement),
          {"diameter [m]", diameter},
          {"mean stress [Pa]", stress}};
}

PolyData stones_as_surfaces(const Simulation& sim, const StonePlaces& before) {
  const std::vector<TriangleMesh> meshes = shown_surfaces(sim.model, sim.state.clumps.size());
  std::vector<Index> rows;
  for (Index i = 0; i < sim.state.clumps.id.size(); ++i) rows.push_back(i);
  return surfaces(posed_stones(sim.state, meshes), stone_data(sim, before, rows));
}

PolyData stones_as_pebbles(const Simulation& sim, const StonePlaces& before) {
  const Clumps& c = sim.state.clumps;
  std::vector<Index> rows;
  std::vector<Vec3> centres;
  std::vector<double> radii;
  for (Index i = 0; i < c.id.size(); ++i) {
    for (const Pebble& pebble : sim.model.templates[static_cast<Index>(c.shape[i])].pebbles) {
      rows.push_back(i);
      centres.push_back(c.position[i] + c.orientation[i] * (c.scale[i] * pebble.centre));
      radii.push_back(c.scale[i] * pebble.radius);
    }
  }
  return spheres(centres, radii, stone_data(sim, before, rows));
}

PolyData contacts_as_lines(const Simulation& sim) {
  const std::vector<Vec3>& position = sim.state.clumps.position;
  std::vector<Vec3> from, to, force;
  std::vector<double> magnitude;
  std::vector<std::int64_t> count;
  for (const BodyPair& pair : pairs_in_touch(sim)) {
    from.push_back(position[static_cast<Index>(pair.clump_1)]);
    to.push_back(pair.wall >= 0 ? pair.point : position[static_cast<Index>(pair.clump_2)]);
    force.push_back(pair.force);
    magnitude.push_back(pair.force.norm());
    count.push_back(pair.contacts);
  }
  return lines_between(
      from, to, {{"force [N]", magnitude}, vector_array("force vector [N]", force), {"contacts", count}});
}

PolyData walls_as_surfaces(const Simulation& sim) {
  std::vector<PosedMesh> meshes;
  std::vector<std::int64_t> index;
  std::vector<Vec3> force;
  for (Index w = 0; w < sim.model.walls.size(); ++w) {
    if (!sim.state.walls[w].present) continue;
    meshes.push_back({&sim.model.walls[w].shape.mesh, sim.state.walls[w].pose, 1.0});
    index.push_back(static_cast<std::int64_t>(w));
    force.push_back(sim.state.walls[w].force);
  }
  return surfaces(meshes, {{"wall", index}, vector_array("force [N]", force)});
}

}  // namespace

Paraview::Paraview(std::filesystem::path folder, std::string stones)
    : folder_((make_folder(folder), std::move(folder))),
      stones_(std::move(stones)),
      stone_series_(folder_ / "stones.pvd"),
      contact_series_(folder_ / "contacts.pvd"),
      wall_series_(folder_ / "walls.pvd") {}

void Paraview::add(TimeSeries& series, const char* name, const PolyData& data, bool is_new) {
  const std::filesystem::path file = folder_ / "frames" / fmt::format("{}-{:05}.vtp", name, frame_);
  write_vtp(file, data);
  if (is_new) series.add(time_, file);
}

void Paraview::add_frame(const Simulation& sim, const StonePlaces& before) {
  make_folder(folder_ / "frames");
  const bool is_new = frame_ < 0 || sim.state.time != time_;
  if (is_new) ++frame_;
  time_ = sim.state.time;
  if (stones_ == "surfaces") add(stone_series_, "stones", stones_as_surfaces(sim, before), is_new);
  if (stones_ == "pebbles") add(stone_series_, "stones", stones_as_pebbles(sim, before), is_new);
  add(contact_series_, "contacts", contacts_as_lines(sim), is_new);
  add(wall_series_, "walls", walls_as_surfaces(sim), is_new);
}

}  // namespace trackbed
