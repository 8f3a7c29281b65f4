#include "geom/stone_generator.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <vector>

#include "base/error.h"
#include "base/rng.h"
#include "geom/mass_properties.h"
#include "geom/primitives.h"
#include "geom/shape.h"

namespace trackbed {
namespace {

constexpr int mesh_level = 4;        // 5120 facets
constexpr int waves = 40;            // of the uneven surface
constexpr double core_radius = 0.5;  // before stretching; a mean stone has 1
constexpr int most_tries = 1000;
constexpr int stretch_rounds = 3;  // to reach the wanted I/L and S/I

/// A stone as a distance from its middle for every direction. The graph of such a function over a sphere can
/// never cross itself, whatever is taken away.
struct RadialStone {
  struct Plane {
    Vec3 normal;
    double offset;
  };
  struct Hollow {
    Vec3 centre;
    double radius;
  };
  struct Wave {
    Vec3 number;
    double phase, amplitude;
  };
  std::vector<Plane> planes;
  std::vector<Hollow> hollows;
  std::vector<Wave> waves;

  /// Where a ray from the middle leaves the stone, and through which of its faces.
  struct Exit {
    double radius = std::numeric_limits<double>::infinity();
    std::size_t face = 0;  // plane, or plane count + hollow
    Vec3 normal = Vec3::Zero();
  };
  Exit exit(const Vec3& direction) const {
    Exit exit;
    for (std::size_t k = 0; k < planes.size(); ++k) {
      const double slope = planes[k].normal.dot(direction);
      if (slope > 1e-9 && planes[k].offset < exit.radius * slope)
        exit = {planes[k].offset / slope, k, planes[k].normal};
    }
    for (std::size_t k = 0; k < hollows.size(); ++k) {  // the near side of the ball, if the ray meets it
      const Hollow& h = hollows[k];
      const double along = h.centre.dot(direction);
      const double root = along * along - h.centre.squaredNorm() + h.radius * h.radius;
      const double r = along - std::sqrt(std::max(root, 0.0));
      if (along > 0 && root > 0 && r < exit.radius)
        exit = {r, planes.size() + k, (h.centre - r * direction).normalized()};
    }
    return exit;
  }

  double radius(const Vec3& direction) const {
    double uneven = 1;
    for (const Wave& w : waves) uneven += w.amplitude * std::cos(w.number.dot(direction) + w.phase);
    return std::max(uneven, 0.5) * exit(direction).radius;
  }
};

Vec3 random_direction(Rng& rng) {
  const double z = rng.uniform(-1, 1), angle = rng.uniform(0, 2 * std::numbers::pi), r = std::sqrt(1 - z * z);
  return {r * std::cos(angle), r * std::sin(angle), z};
}

double draw(Rng& rng, const Interval& range) {
  return rng.uniform(range.low, range.high);
}
int draw_count(Rng& rng, const Interval& range) {
  return static_cast<int>(std::floor(rng.uniform(range.low, range.high + 1)));
}

/// Normals keep their distance from one another, so that the planes close the stone on all sides: of a few
/// candidates the one farthest from those before is taken (Mitchell's best candidate).
std::vector<RadialStone::Plane> draw_planes(Rng& rng, int count) {
  std::vector<RadialStone::Plane> planes;
  for (int k = 0; k < count; ++k) {
    Vec3 best = random_direction(rng);
    double nearest = 2;
    for (int tries = 0; tries < 2; ++tries) {
      const Vec3 normal = random_direction(rng);
      double closest = -1;
      for (const auto& p : planes) closest = std::max(closest, p.normal.dot(normal));
      if (closest < nearest) nearest = closest, best = normal;
    }
    planes.push_back({best, rng.uniform(0.72, 1.15)});
  }
  return planes;
}

RadialStone draw_stone(Rng& rng, const StoneRecipe& recipe) {
  RadialStone stone;
  stone.planes = draw_planes(rng, draw_count(rng, recipe.faces));
  const int hollows = draw_count(rng, recipe.hollows);
  for (int k = 0; k < hollows; ++k) {
    const Vec3 direction = random_direction(rng);
    const double radius = rng.uniform(1, 3), surface = stone.exit(direction).radius;
    // Scars do not dig on where earlier ones have reached the core: the middle always lies inside the stone.
    const double floor = std::max(surface - draw(rng, recipe.hollow_depth), std::min(surface, core_radius));
    stone.hollows.push_back({(floor + radius) * direction, radius});
  }
  if (recipe.roughness > 0) {
    for (int k = 0; k < waves; ++k) {
      const double number = rng.uniform(2, 14);  // lengths from the whole stone down to a few facets
      stone.waves.push_back({number * random_direction(rng), rng.uniform(0, 2 * std::numbers::pi),
                             recipe.roughness * 2.5 / (number * std::sqrt(waves / 8.0))});
    }
  }
  return stone;
}

/// The planes' polyhedron, exact: its corners are the facets of the hull of the dual points normal / offset.
TriangleMesh polyhedron(const std::vector<RadialStone::Plane>& planes) {
  TriangleMesh dual;
  for (const auto& p : planes) dual.vertices.push_back(p.normal / p.offset);
  dual = convex_hull(dual);
  TriangleMesh corners;
  for (std::size_t f = 0; f < dual.facets.size(); ++f) {
    const auto [a, b, c] = dual.corners(f);
    const Vec3 normal = (b - a).cross(c - a);
    corners.vertices.push_back(normal / normal.dot(a));
  }
  return convex_hull(corners);
}

std::vector<std::vector<std::size_t>> facets_around_vertices(const TriangleMesh& mesh) {
  std::vector<std::vector<std::size_t>> around(mesh.vertices.size());
  for (std::size_t f = 0; f < mesh.facets.size(); ++f)
    for (int corner : mesh.facets[f]) around[static_cast<std::size_t>(corner)].push_back(f);
  return around;
}

/// Moves vertices of the unit sphere to where an edge or corner of the stone will pass beside them, so that
/// edges are not jagged: to the point nearest to the planes that touch the faces seen by the vertex and its
/// neighbours. No facet may shrink to less than a third of its solid angle, so none turns over.
void move_to_edges(TriangleMesh& sphere, const RadialStone& stone) {
  const auto around = facets_around_vertices(sphere);
  std::vector<RadialStone::Exit> exits;
  for (const Vec3& v : sphere.vertices) exits.push_back(stone.exit(v));
  const auto size = [&](std::size_t f) {
    const auto [a, b, c] = sphere.corners(f);
    return a.dot(b.cross(c));
  };
  std::vector<double> least(sphere.facets.size());
  for (std::size_t f = 0; f < least.size(); ++f) least[f] = size(f) / 3;

  for (std::size_t v = 0; v < sphere.vertices.size(); ++v) {
    const Vec3 place = sphere.vertices[v], here = exits[v].radius * place;
    Mat3 matrix = 0.02 * Mat3::Identity();
    Vec3 vector = Vec3::Zero();
    std::vector<std::size_t> faces;
    for (std::size_t f : around[v]) {
      for (int corner : sphere.facets[f]) {
        const auto k = static_cast<std::size_t>(corner);
        const auto& exit = exits[k];
        if (std::find(faces.begin(), faces.end(), exit.face) != faces.end()) continue;
        faces.push_back(exit.face);
        matrix += exit.normal * exit.normal.transpose();
        vector += exit.normal * exit.normal.dot(exit.radius * sphere.vertices[k] - here);
      }
    }
    if (faces.size() < 2) continue;
    sphere.vertices[v] = (here + matrix.ldlt().solve(vector)).normalized();
    for (std::size_t f : around[v])
      if (size(f) < least[f]) sphere.vertices[v] = place;
    exits[v] = stone.exit(sphere.vertices[v]);
  }
}

TriangleMesh radial_mesh(const RadialStone& stone) {
  TriangleMesh mesh = icosphere(mesh_level, 1);
  move_to_edges(mesh, stone);
  for (Vec3& v : mesh.vertices) v *= stone.radius(v);
  return mesh;
}

/// Turns the box's axes onto x, y, z and stretches the stone until its box has the wanted proportions.
void stretch(TriangleMesh& mesh, double elongation, double flatness) {
  for (int round = 0; round < stretch_rounds; ++round) {
    const Shape shape = measure_shape(mesh);
    Mat3 axes = shape.box_axes;
    axes.col(2) = axes.col(0).cross(axes.col(1));
    const Vec3 factor(1, elongation * shape.length / shape.breadth,
                      elongation * flatness * shape.length / shape.thickness);
    for (Vec3& v : mesh.vertices) v = factor.asDiagonal() * (axes.transpose() * v);
  }
}

void check(const StoneRecipe& r) {
  const auto fits = [](const Interval& range, double low, double high, const char* what) {
    if (!(range.low >= low && range.low <= range.high && range.high <= high))
      throw InputError(
          fmt::format("stone generator: {} must lie from {:g} to {:g}, low before high, not {:g} to {:g}",
                      what, low, high, range.low, range.high));
  };
  fits(r.faces, 6, 200, "the number of faces");
  fits(r.elongation, 0.1, 1, "the elongation I/L");
  fits(r.flatness, 0.1, 1, "the flatness S/I");
  fits(r.hollows, 0, 100, "the number of hollows");
  fits(r.hollow_depth, 0, 0.5, "the depth of a hollow");
  fits({r.roughness, r.roughness}, 0, 0.1, "the roughness");
  if (!(r.sieve_size > 0)) throw InputError("stone generator: the sieve size must be positive");
  if (!(r.largest_l_over_s * r.elongation.high * r.flatness.high > 1.01))
    throw InputError("stone generator: no stone of this elongation and flatness has so small an L/S");
}

}  // namespace

StoneRecipe convex_recipe() {
  StoneRecipe recipe;
  recipe.hollows = {0, 0};
  recipe.roughness = 0;
  return recipe;
}

TriangleMesh generate_stone(const StoneRecipe& recipe, std::uint64_t seed, int index) {
  check(recipe);
  Rng rng(seed, fmt::format("stone {}", index));
  for (int tries = 0; tries < most_tries; ++tries) {
    const double elongation = draw(rng, recipe.elongation), flatness = draw(rng, recipe.flatness);
    if (elongation * flatness * recipe.largest_l_over_s < 1) continue;
    const RadialStone stone = draw_stone(rng, recipe);
    const bool convex = stone.hollows.empty() && stone.waves.empty();
    TriangleMesh mesh = convex ? polyhedron(stone.planes) : radial_mesh(stone);
    stretch(mesh, elongation, flatness);
    const Shape shape = measure_shape(mesh);
    // Stretched, the stone may have found a tighter box that lies otherwise.
    const bool as_wanted = std::abs(shape.elongation / elongation - 1) < 0.03 &&
                           std::abs(shape.flatness / flatness - 1) < 0.03 &&
                           shape.length <= recipe.largest_l_over_s * shape.thickness;
    if (!as_wanted) continue;
    const double scale = recipe.sieve_size / shape.sieve_size;
    const Vec3 centre = mass_properties(mesh).centre;
    for (Vec3& v : mesh.vertices) v = scale * (v - centre);
    return mesh;
  }
  throw InputError(
      fmt::format("stone generator: none of {} stones drawn has the wanted proportions", most_tries));
}

}  // namespace trackbed
