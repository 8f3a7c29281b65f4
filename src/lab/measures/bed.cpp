#include <algorithm>
#include <cmath>
#include <numeric>

#include "dem/touching.h"
#include "lab/in_touch.h"
#include "lab/measures/measures.h"
#include "lab/measures/surface.h"
#include "lab/room.h"

namespace trackbed {
using Index = std::size_t;

double solid_volume(const Simulation& sim) {
  double sum = 0;
  for (Index i = 0; i < sim.state.clumps.id.size(); ++i) sum += volume_of(sim, i);
  return sum;
}

double largest_displacement(const Simulation& sim) {
  double largest = 0;
  for (const Vec3& moved : displacements(sim.state, sim.places)) largest = std::max(largest, moved.norm());
  return largest;
}

double weight(const Simulation& sim) {
  const std::vector<double>& masses = sim.state.clumps.mass;
  double mass = std::accumulate(masses.begin(), masses.end(), 0.0);
  for (Index w = 0; w < sim.model.walls.size(); ++w)
    if (sim.model.walls[w].body && sim.state.walls[w].present) mass += sim.model.walls[w].body->mass;
  return mass * sim.model.gravity.norm();
}

double weight_borne(const Simulation& sim) {
  const Clumps& c = sim.state.clumps;
  double borne = 0, weight = 0;
  for (Index i = 0; i < c.id.size(); ++i) {
    borne -= c.force[i].dot(sim.model.gravity);
    weight += c.mass[i] * sim.model.gravity.squaredNorm();
  }
  return weight > 0 ? borne / weight : 0.0;
}

double median_size(const Simulation& sim) {
  const Clumps& c = sim.state.clumps;
  std::vector<std::pair<double, double>> stones;  // diameter, mass
  double total = 0;
  for (Index i = 0; i < c.id.size(); ++i) {
    stones.emplace_back(2 * equal_volume_radius(sim, i), c.mass[i]);
    total += c.mass[i];
  }
  std::ranges::sort(stones);
  double finer = 0;
  for (const auto& [diameter, mass] : stones)
    if ((finer += mass) >= 0.5 * total) return diameter;
  return 0.0;
}

double volume_below(const WallShape& shape, const Pose& pose, double z) {
  // Divergence theorem for the field (0, 0, min(height - z, 0)): each facet adds its shadow times its mean
  // depth, the facets through z only their part below.
  double volume = 0;
  for (Index f = 0; f < shape.mesh.facets.size(); ++f) {
    const auto corners = shape.mesh.corners(f);
    std::vector<Vec3> below;
    for (Index k = 0; k < 3; ++k) {
      const Vec3 p = pose.to_world(corners[k]) - Vec3(0, 0, z),
                 q = pose.to_world(corners[(k + 1) % 3]) - Vec3(0, 0, z);
      if (p.z() <= 0) below.push_back(p);
      if ((p.z() < 0) != (q.z() < 0) && p.z() != 0 && q.z() != 0)
        below.push_back(p + p.z() / (p.z() - q.z()) * (q - p));
    }
    for (Index k = 2; k < below.size(); ++k) {
      const double shadow = 0.5 * (below[k - 1] - below[0]).cross(below[k] - below[0]).z();
      volume += shadow * (below[0].z() + below[k - 1].z() + below[k].z()) / 3.0;
    }
  }
  return volume;
}

double pebble_volume(const Simulation& sim) {
  const Clumps& c = sim.state.clumps;
  double sum = 0;
  for (Index i = 0; i < c.id.size(); ++i)
    sum += sim.model.templates[static_cast<Index>(c.shape[i])].pebble_volume *
           sim.model.space.growth_of_volume(c.scale[i]);
  return sum;
}

double bed_volume(const Simulation& sim) {
  const Eigen::AlignedBox3d container = container_now(sim);
  if (container.isEmpty()) return 0.0;
  const Surface surface = surface_of(sim, footprint(container));
  const LocalHeights heights = surface.local();
  if (sim.container_mesh >= 0 || !sim.trays.empty()) {
    Eigen::AlignedBox3d below = container;
    below.max().z() = heights.highest();
    return below.max().z() > below.min().z()
               ? volume_in(
                     below,
                     [&](const Vec3& x) { return x.z() < heights.at(x.head<2>()) && is_in_room(sim, x); },
                     sim.model.space)
               : 0.0;
  }
  double volume = container.sizes().head<2>().prod() * (heights.mean() - container.min().z());
  for (Index w = 0; w < sim.model.walls.size(); ++w) {
    if (!sim.model.walls[w].body || !sim.state.walls[w].present) continue;
    const WallShape& shape = sim.model.walls[w].shape;
    const Pose& pose = sim.state.walls[w].pose;
    volume -= volume_below(shape, pose, heights.mean_over(footprint(shape, pose)));
  }
  return volume;
}

double porosity(const Simulation& sim, double solid) {
  return solid == 0 ? 1.0 : 1.0 - solid / bed_volume(sim);
}

BedStress bed_stress(const Simulation& sim) {
  BedStress stress;
  if (sim.container.isEmpty() || sim.state.clumps.size() == 0) return stress;
  stress.volume = bed_volume(sim);
  visit_touching(sim.model, sim.state, [&](const Touching& t) {
    const Vec3 branch = t.clump_2 >= 0 ? Vec3(t.lever_1 - t.lever_2) : t.lever_1;
    const double along = branch.dot(t.normal);
    stress.mean += t.force().dot(branch) / (sim.model.space.dimensions() * stress.volume);
    stress.stiffness += t.properties->kn * along * along;
  });
  return stress;
}

}  // namespace trackbed
