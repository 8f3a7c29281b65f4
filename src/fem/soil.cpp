#include "fem/soil.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "base/error.h"

namespace trackbed::fem {

namespace {

/// How many elements a length is; throws when it is no multiple.
int elements(const char* key, double length, double size) {
  const double n = length / size;
  if (!(n > 0.5) || std::abs(n - std::round(n)) > 1e-6)
    throw InputError(
        fmt::format("{} is {} m; it must be a multiple of the element size, {} m", key, length, size));
  return static_cast<int>(std::lround(n));
}

Section make_section(const SoilInput& in) {
  const double h = in.element_size;
  const int below = elements("subgrade_depth", in.subgrade_depth, h);
  const int half = elements("half_width", in.half_width, h);
  if (!(in.crest <= in.half_width + 1e-9) || !(in.shoulder_slope >= 0))
    throw InputError(
        fmt::format("crest is {} m and shoulder_slope {}; the crest must lie within half_width, {} m, and "
                    "the slope be 0 or more",
                    in.crest, in.shoulder_slope, in.half_width));
  Section s;
  s.across = in.whole_width ? 2 * half : half;
  s.up = below + elements("ballast_depth", in.ballast_depth, h);
  s.y0 = in.whole_width ? -in.half_width : 0;
  s.z0 = -s.up * h;
  s.dy = s.dz = h;
  for (int k = 0; k < s.up; ++k)
    for (int j = 0; j < s.across; ++j) {
      const double y = std::abs(s.y0 + (j + 0.5) * h), depth = -(s.z0 + (k + 0.5) * h);
      s.materials.push_back(k < below ? 1 : y < in.crest + in.shoulder_slope * depth - 1e-9 ? 0 : -1);
    }
  return s;
}

/// Areas of the nodes of a row of n elements of size h.
Eigen::VectorXd node_shares(int n, double h) {
  Eigen::VectorXd w = Eigen::VectorXd::Constant(n + 1, h);
  w[0] = w[n] = h / 2;
  return w;
}

/// Products of Legendre polynomials over one half, made orthonormal under the nodes' areas (Gram and
/// Schmidt).
Eigen::MatrixXd half_shapes(int along, int across, const Eigen::VectorXd& area) {
  Eigen::MatrixXd shapes((along + 1) * (across + 1), 6);
  for (int row = 0; row <= across; ++row)
    for (int a = 0; a <= along; ++a) {
      const double y = 2.0 * row / across - 1, x = 2.0 * a / along - 1;
      const double p2 = 1.5 * y * y - 0.5;
      shapes.row(row * (along + 1) + a) << 1, y, p2, x, x * y, x * p2;
    }
  for (int s = 0; s < 6; ++s) {
    for (int again = 0; again < 2; ++again)
      for (int t = 0; t < s; ++t)
        shapes.col(s) -= shapes.col(t).dot(area.asDiagonal() * shapes.col(s)) * shapes.col(t);
    shapes.col(s) /= std::sqrt(shapes.col(s).dot(area.asDiagonal() * shapes.col(s)));
  }
  return shapes;
}

void make_shapes(Soil& soil, int along, int across) {
  const double h = soil.input.element_size;
  const Eigen::VectorXd area_half = (node_shares(along, h) * node_shares(across, h).transpose()).reshaped();
  const Eigen::MatrixXd half = half_shapes(along, across, area_half);
  const Eigen::MatrixXd half_forces = area_half.asDiagonal() * half;
  if (!soil.input.whole_width) {
    soil.area = area_half;
    soil.shapes = half;
    soil.shape_forces = half_forces;
    return;
  }
  // Shapes of the half y < 0 are those of y > 0 mirrored; both have the nodes of the middle.
  soil.area.setZero(soil.nodes_per_footing());
  soil.shapes.setZero(soil.nodes_per_footing(), 12);
  soil.shape_forces = soil.shapes;
  for (int row = 0; row <= across; ++row)
    for (int a = 0; a <= along; ++a) {
      const int from = row * (along + 1) + a;
      const int right = (across + row) * (along + 1) + a, left = (across - row) * (along + 1) + a;
      soil.area[right] += area_half[from];
      soil.area[left] += area_half[from];
      soil.shapes.row(right).tail(6) = soil.shapes.row(left).head(6) = half.row(from);
      soil.shape_forces.row(right).tail(6) = soil.shape_forces.row(left).head(6) = half_forces.row(from);
    }
}

void place_footings(Soil& soil) {
  const SoilInput& in = soil.input;
  const double h = in.element_size;
  const int along = elements("sleeper_width", in.sleeper_width, h);
  const int across = elements("sleeper_half_length", in.sleeper_half_length, h);
  const int pitch = elements("sleeper_spacing", in.sleeper_spacing, h);
  if (in.sleeper_half_length > in.crest + 1e-9)
    throw InputError(
        fmt::format("sleeper_half_length is {} m; sleepers must lie on the crest of the ballast, {} m",
                    in.sleeper_half_length, in.crest));
  const int first = static_cast<int>(std::lround((in.first_sleeper - in.sleeper_width / 2) / h));
  if (in.sleepers < 1 || first < 0 || first + (in.sleepers - 1) * pitch + along >= soil.planes)
    throw InputError(fmt::format("{} sleepers {} m apart from {} m do not lie on {} m of ground", in.sleepers,
                                 in.sleeper_spacing, in.first_sleeper, in.length));
  for (int f = 0; f < in.sleepers; ++f) soil.first_plane.push_back(first + f * pitch);
  soil.nodes_along = along + 1;
  soil.nodes_across = (in.whole_width ? 2 * across : across) + 1;
  const int middle = in.whole_width ? soil.section.across / 2 : 0;
  for (int row = 0; row < soil.nodes_across; ++row) {
    const int j = row + middle - (in.whole_width ? across : 0);
    soil.footing_section_nodes.push_back(
        soil.section_nodes.number[static_cast<std::size_t>(soil.section.up * (soil.section.across + 1) + j)]);
  }
  make_shapes(soil, along, across);
}

}  // namespace

Soil make_soil(const SoilInput& in) {
  if (!(in.element_size > 0))
    throw InputError(fmt::format("element_size is {} m; it must be positive", in.element_size));
  Soil soil;
  soil.input = in;
  soil.materials = {in.ballast, in.subgrade};
  soil.section = make_section(in);
  soil.section_nodes = section_nodes(soil.section);
  soil.planes = elements("length", in.length, in.element_size) + 1;
  place_footings(soil);
  return soil;
}

double Soil::x_of(int footing) const {
  return (first_plane[static_cast<std::size_t>(footing)] + 0.5 * (nodes_along - 1)) * input.element_size;
}

bool Soil::is_held(int plane, int section_node, int axis) const {
  const auto [j, k] = section_nodes.grid[static_cast<std::size_t>(section_node)];
  auto holds = [&](Support s, int across) {
    return s == Support::fixed || (s == Support::roller && axis == across);
  };
  if (k == 0 && holds(input.base, 2)) return true;
  if ((j == section.across || (input.whole_width && j == 0)) && holds(input.side, 1)) return true;
  if (!input.whole_width && j == 0 && axis == 1) return true;  // symmetry
  if (plane == 0 && holds(input.start, 0)) return true;
  return plane == planes - 1 && holds(input.end, 0);
}

Vec3 Soil::dashpot(int plane, int section_node) const {
  const auto [j, k] = section_nodes.grid[static_cast<std::size_t>(section_node)];
  const double h = input.element_size;
  const double lengthwise = plane == 0 || plane == planes - 1 ? h / 2 : h;
  Vec3 c = Vec3::Zero();
  auto add = [&](int material, double share, int across) {
    if (material < 0) return;
    const Elastic& solid = materials[static_cast<std::size_t>(material)];
    for (int axis = 0; axis < 3; ++axis)
      c[axis] +=
          share * solid.density * (axis == across ? solid.pressure_wave_speed() : solid.shear_wave_speed());
  };
  const bool at_end = (plane == 0 && input.start == Support::absorbing) ||
                      (plane == planes - 1 && input.end == Support::absorbing);
  for (int dk = -1; dk <= 0; ++dk)
    for (int dj = -1; at_end && dj <= 0; ++dj) add(section.material(j + dj, k + dk), h * h / 4, 0);
  if (input.side == Support::absorbing)
    for (int dk = -1; dk <= 0; ++dk) {
      if (j == section.across) add(section.material(j - 1, k + dk), lengthwise * h / 2, 1);
      if (j == 0 && input.whole_width) add(section.material(0, k + dk), lengthwise * h / 2, 1);
    }
  if (input.base == Support::absorbing && k == 0)
    for (int dj = -1; dj <= 0; ++dj) add(section.material(j + dj, 0), lengthwise * h / 2, 2);
  return c;
}

double Soil::mass(int plane, int section_node) const {
  const auto [j, k] = section_nodes.grid[static_cast<std::size_t>(section_node)];
  const double h = input.element_size;
  double m = 0;
  for (int dk = -1; dk <= 0; ++dk)
    for (int dj = -1; dj <= 0; ++dj) {
      const int material = section.material(j + dj, k + dk);
      if (material >= 0) m += materials[static_cast<std::size_t>(material)].density * h * h * h / 8;
    }
  return plane == 0 || plane == planes - 1 ? m : 2 * m;
}

}  // namespace trackbed::fem
