#include "lab/picture_of_bed.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "io/picture.h"
#include "lab/in_touch.h"
#include "lab/shown.h"

namespace trackbed {
namespace {

using Index = std::size_t;

constexpr Colour body_colour{0.85f, 0.72f, 0.52f};  // wood

/// Greys that tell neighbouring stones apart, the same for a stone in every picture.
Colour stone_colour(int id) {
  const float shade = 0.52f + 0.30f * static_cast<float>((id * 37) % 64) / 63.0f;
  return {shade, shade * 0.98f, shade * 0.94f};
}

Eigen::AlignedBox3d box_of_bed(const Simulation& sim) {
  Eigen::AlignedBox3d box;
  const Clumps& c = sim.state.clumps;
  for (Index i = 0; i < c.id.size(); ++i) {
    const double reach = c.scale[i] * sim.model.templates[static_cast<Index>(c.shape[i])].bounding_radius;
    box.extend((c.position[i].array() - reach).matrix()).extend((c.position[i].array() + reach).matrix());
  }
  for (Index w = 0; w < sim.model.walls.size(); ++w) {
    if (!sim.model.walls[w].body || !sim.state.walls[w].present) continue;
    for (const Vec3& v : sim.model.walls[w].shape.mesh.vertices)
      box.extend(sim.state.walls[w].pose.to_world(v));
  }
  if (box.isEmpty()) box.extend(Vec3::Zero()).extend(Vec3::Ones());
  return box;
}

void draw_bodies(const Simulation& sim, Picture& picture) {
  for (Index w = 0; w < sim.model.walls.size(); ++w)
    if (sim.model.walls[w].body && sim.state.walls[w].present)
      picture.draw_mesh(sim.model.walls[w].shape.mesh, sim.state.walls[w].pose, 1.0, body_colour);
}

/// Stones whose centre lies at or behind `front` (y); `colour` takes the stone's index.
template <class ColourOf>
void draw_stones(const Simulation& sim, const std::vector<TriangleMesh>& surfaces, double front,
                 const ColourOf& colour, Picture& picture) {
  const std::vector<PosedMesh> stones = posed_stones(sim.state, surfaces);
  for (Index i = 0; i < stones.size(); ++i)
    if (stones[i].pose.position.y() >= front)
      picture.draw_mesh(*stones[i].mesh, stones[i].pose, stones[i].scale, colour(i));
}

/// From blue (weak) over yellow to red (strong); share from 0 to 1.
Colour colour_of_share(double share) {
  const auto s = static_cast<float>(share);
  if (s < 0.5f) return {0.25f + 1.3f * s, 0.45f + 0.7f * s, 0.85f - 1.2f * s};
  return {0.9f, 0.8f - 1.2f * (s - 0.5f), 0.25f - 0.2f * (s - 0.5f)};
}

bool is_long(const Eigen::AlignedBox3d& box) {
  return box.sizes().x() > 3 * box.sizes().z();
}

/// Where two views go: beside each other, or one above the other when the bed is long.
std::array<Viewport, 2> two_views(const Eigen::AlignedBox3d& box) {
  if (is_long(box)) return {{{0.01, 0.02, 0.98, 0.47}, {0.01, 0.51, 0.98, 0.47}}};
  return {{{0.01, 0.02, 0.48, 0.96}, {0.51, 0.02, 0.48, 0.96}}};
}

}  // namespace

void draw_bed(const Simulation& sim, const std::filesystem::path& png) {
  const std::vector<TriangleMesh> surfaces = shown_surfaces(sim.model, sim.state.clumps.size());
  const Eigen::AlignedBox3d box = box_of_bed(sim);
  const auto grey = [&](Index i) { return stone_colour(sim.state.clumps.id[i]); };
  Picture picture(1600, 800);
  picture.look(Vec3(0.35, 1.0, -0.55), box, two_views(box)[0]);
  draw_stones(sim, surfaces, box.min().y(), grey, picture);
  draw_bodies(sim, picture);
  picture.look(Vec3(0.0, 1.0, 0.0), box, two_views(box)[1]);
  draw_stones(sim, surfaces, box.center().y(), grey, picture);
  draw_bodies(sim, picture);
  picture.write_png(png);
}

void draw_displacements(const Simulation& sim, const std::vector<Vec3>& moved, std::optional<double> scale,
                        const std::filesystem::path& png) {
  const std::vector<TriangleMesh> surfaces = shown_surfaces(sim.model, sim.state.clumps.size());
  const Eigen::AlignedBox3d box = box_of_bed(sim);
  double largest = 0;
  for (const Vec3& way : moved) largest = std::max(largest, way.norm());
  if (scale) largest = *scale;
  const auto colour = [&](Index i) {
    return colour_of_share(largest > 0 ? std::min(1.0, moved[i].norm() / largest) : 0.0);
  };
  Picture picture(1600, 800);
  picture.look(Vec3(0.0, 1.0, 0.0), box, two_views(box)[0]);
  draw_stones(sim, surfaces, box.center().y(), colour, picture);
  draw_bodies(sim, picture);
  picture.look(Vec3(0.0, 0.05, -1.0), box, two_views(box)[1]);
  draw_stones(sim, surfaces, box.min().y(), colour, picture);
  draw_bodies(sim, picture);
  picture.write_png(png);
}

void draw_forces(const Simulation& sim, const std::filesystem::path& png) {
  const std::vector<BodyPair> pairs = pairs_in_touch(sim);
  const std::vector<Vec3>& position = sim.state.clumps.position;
  double largest = 0, reach = 0;
  for (const BodyPair& pair : pairs) largest = std::max(largest, pair.force.norm());
  for (Index i = 0; i < position.size(); ++i) reach = std::max(reach, equal_volume_radius(sim, i));

  const Eigen::AlignedBox3d box = box_of_bed(sim);
  Picture picture = is_long(box) ? Picture(1600, 400) : Picture(1000, 800);
  picture.look(Vec3(0.0, 1.0, -0.12), box, {0.02, 0.02, 0.96, 0.96});
  draw_bodies(sim, picture);
  for (const BodyPair& pair : pairs) {
    const double share = largest > 0 ? std::sqrt(pair.force.norm() / largest) : 0.0;
    const Vec3& from = position[static_cast<Index>(pair.clump_1)];
    const Vec3& to = pair.wall >= 0 ? pair.point : position[static_cast<Index>(pair.clump_2)];
    picture.draw_cylinder(from, to, 0.4 * reach * share, colour_of_share(share));
  }
  picture.write_png(png);
}

}  // namespace trackbed
