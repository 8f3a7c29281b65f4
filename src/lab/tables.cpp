#include "lab/tables.h"

#include <string>

#include "dem/touching.h"
#include "io/csv.h"
#include "lab/in_touch.h"

namespace trackbed {
namespace {

using Index = std::size_t;

void add_vector(std::vector<Column>& columns, const std::string& name, Dimension dimension) {
  for (const char* axis : {"x", "y", "z"})
    columns.push_back({name.empty() ? axis : name + "_" + axis, dimension});
}

void add_vector(std::vector<Cell>& row, const Vec3& v) {
  row.insert(row.end(), {v.x(), v.y(), v.z()});
}

std::vector<Column> contact_columns() {
  using enum Dimension;
  std::vector<Column> columns{{"stone_1"}, {"pebble_1"}, {"stone_2"}, {"wall", none, true}};
  add_vector(columns, "", length);
  add_vector(columns, "normal", none);
  columns.push_back({"force", force});
  columns.push_back({"normal_force", force});
  add_vector(columns, "shear_force", force);
  add_vector(columns, "force", force);
  columns.push_back({"overlap", length});
  columns.push_back({"slips"});
  return columns;
}

std::vector<Column> stone_columns() {
  using enum Dimension;
  std::vector<Column> columns{{"id"}, {"template", none, true}, {"mass", mass}, {"diameter", length}};
  add_vector(columns, "", length);
  for (const char* part : {"qw", "qx", "qy", "qz"}) columns.push_back({part});
  add_vector(columns, "velocity", velocity);
  add_vector(columns, "spin", angular_velocity);
  columns.push_back({"neighbours"});
  columns.push_back({"contacts"});
  add_vector(columns, "force", force);
  columns.push_back({"mean_stress", stress});
  add_vector(columns, "displacement", length);
  return columns;
}

/// The shear force has reached the friction limit, up to rounding.
bool slips(const Touching& t) {
  const double limit = t.properties->friction * t.properties->kn * t.overlap;
  return t.memory->shear.norm() >= limit * (1 - 1e-9);
}

}  // namespace

void write_contacts(const Simulation& sim, const std::filesystem::path& path) {
  CsvWriter table(path, contact_columns());
  const std::vector<int>& id = sim.state.clumps.id;
  visit_touching(sim.model, sim.state, [&](const Touching& t) {
    const double other = t.clump_2 >= 0 ? id[static_cast<Index>(t.clump_2)] : -1;
    const std::string_view wall =
        t.wall >= 0 ? std::string_view(sim.model.walls[static_cast<Index>(t.wall)].shape.name) : "";
    std::vector<Cell> row{double(id[static_cast<Index>(t.clump_1)]), double(t.pebble_1), other, wall};
    add_vector(row, t.point);
    add_vector(row, t.normal);
    row.insert(row.end(), {t.force().norm(), t.properties->kn * t.overlap});
    add_vector(row, t.memory->shear);
    add_vector(row, t.force());
    row.insert(row.end(), {t.overlap, slips(t) ? 1.0 : 0.0});
    table.add_row(row);
  });
}

void write_stones(const Simulation& sim, const StonePlaces& before, const std::filesystem::path& path) {
  CsvWriter table(path, stone_columns());
  const Clumps& c = sim.state.clumps;
  const std::vector<StoneContacts> contacts = contacts_of_stones(sim);
  const std::vector<Vec3> moved = displacements(sim.state, before);
  for (Index i = 0; i < c.id.size(); ++i) {
    const ClumpTemplate& shape = sim.model.templates[static_cast<Index>(c.shape[i])];
    const Quat& q = c.orientation[i];
    std::vector<Cell> row{double(c.id[i]), std::string_view(shape.name), c.mass[i],
                          2 * equal_volume_radius(sim, i)};
    add_vector(row, c.position[i]);
    row.insert(row.end(), {q.w(), q.x(), q.y(), q.z()});
    add_vector(row, c.velocity[i]);
    add_vector(row, c.angular_velocity[i]);
    row.insert(row.end(), {double(contacts[i].neighbours), double(contacts[i].contacts)});
    add_vector(row, c.force[i]);
    row.emplace_back(contacts[i].mean_stress);
    add_vector(row, moved[i]);
    table.add_row(row);
  }
}

}  // namespace trackbed
