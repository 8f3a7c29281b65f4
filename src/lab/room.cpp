#include "lab/room.h"

#include <algorithm>
#include <cmath>

#include "dem/overlap.h"

namespace trackbed {

using Index = std::size_t;

void check_room(const Document& document, const std::string& key, const Simulation& sim) {
  if (sim.container.isEmpty())
    document.fail(
        key, "there is no container to fill",
        "add a wall of kind box, such as [walls.box], trays, or a closed mesh with container = true");
}

Eigen::AlignedBox3d container_now(const Simulation& sim) {
  const auto place = [&](int wall) -> const Vec3& {
    return sim.state.walls[static_cast<Index>(wall)].pose.position;
  };
  if (!sim.trays.empty()) {
    Eigen::AlignedBox3d box;
    for (const Tray& tray : sim.trays) box.extend(tray.inside.translated(place(tray.wall)));
    return box;
  }
  if (const int mesh = sim.container_mesh; mesh >= 0)
    return sim.container.translated(place(mesh) - sim.wall_reference[static_cast<Index>(mesh)].position);
  Eigen::AlignedBox3d box = sim.container;
  for (const BoxSide& side : sim.sides)
    if (sim.state.walls[static_cast<Index>(side.wall)].present)
      (side.is_high ? box.max() : box.min())[side.axis] = place(side.wall)[side.axis];
  return box;
}

bool is_in_room(const Simulation& sim, const Vec3& point) {
  const auto holds = [&](const Tray& tray) {
    const WallState& wall = sim.state.walls[static_cast<Index>(tray.wall)];
    return wall.present && tray.inside.contains(wall.pose.to_body(point));
  };
  if (sim.trays.empty() ? !container_now(sim).contains(point) : std::ranges::none_of(sim.trays, holds))
    return false;
  for (Index w = 0; w < sim.model.walls.size(); ++w) {
    if (!sim.state.walls[w].present) continue;
    const Wall& wall = sim.model.walls[w];
    const Vec3 seen = sim.state.walls[w].pose.to_body(point);
    if (wall.shape.is_plane && seen.z() < 0) return false;
    if (static_cast<int>(w) == sim.container_mesh && !is_inside(wall.shape, seen)) return false;
    if (wall.body && is_inside(wall.shape, seen)) return false;
  }
  return true;
}

double volume_in(const Eigen::AlignedBox3d& box, const Region& region, const Space& space) {
  const Vec3 size = box.sizes();
  const double step = (space.is_plane() ? std::min(size.x(), size.z()) : size.minCoeff()) / 100;
  Eigen::Array3d n = (size.array() / step).round();
  if (space.is_plane()) n.y() = 1;
  double inside = 0;
  for (int x = 0; x < n.x(); ++x)
    for (int y = 0; y < n.y(); ++y)
      for (int z = 0; z < n.z(); ++z) {
        const Vec3 share = (Eigen::Array3d(x, y, z) + 0.5) / n;
        if (region(box.min() + share.cwiseProduct(size))) ++inside;
      }
  return inside / n.prod() * size.prod();
}

Vec3 point_in(const Eigen::AlignedBox3d& box, Rng& rng, const Region& region) {
  const Vec3 low = box.min(), high = box.max();
  for (;;) {
    const double x = rng.uniform(low.x(), high.x()), y = rng.uniform(low.y(), high.y()),
                 z = rng.uniform(low.z(), high.z());
    if (region({x, y, z})) return {x, y, z};
  }
}

bool is_clear_of_walls(const Simulation& sim, int stone, double clearance, Walls which) {
  for (Index w = 0; w < sim.state.walls.size(); ++w) {
    if (!sim.state.walls[w].present) continue;
    if (which == Walls::of_triangles && sim.model.walls[w].shape.is_plane) continue;
    if (stone_meets_wall(sim.model, sim.state, stone, static_cast<int>(w), clearance)) return false;
  }
  return true;
}

}  // namespace trackbed
