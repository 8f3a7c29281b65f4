#include "lab/bed_file.h"

#include <charconv>
#include <cmath>
#include <map>
#include <numbers>
#include <string_view>

#include <fmt/format.h>

#include <Eigen/Eigenvalues>
#include <Eigen/SVD>

#include "base/error.h"
#include "geom/clump_error.h"
#include "io/files.h"

namespace trackbed {
namespace {

/// Numbers of one line; empty for a comment.
std::vector<double> numbers_of(std::string_view line, const std::filesystem::path& file, int number) {
  std::vector<double> values;
  const char* at = line.data();
  const char* end = at + line.size();
  while (at != end && *at != '#') {
    if (*at == ' ' || *at == '\t' || *at == '\r') {
      ++at;
      continue;
    }
    double value = 0;
    const auto [next, error] = std::from_chars(at, end, value);
    if (error != std::errc() || !std::isfinite(value))
      throw InputError(fmt::format("{}:{}: not a number; a line is x y z r [clump]", file.string(), number));
    values.push_back(value);
    at = next;
  }
  if (!values.empty() && values.size() != 4 && values.size() != 5)
    throw InputError(
        fmt::format("{}:{}: {} numbers; a line is x y z r [clump]", file.string(), number, values.size()));
  if (!values.empty() && values[3] <= 0)
    throw InputError(fmt::format("{}:{}: the radius is not positive", file.string(), number));
  return values;
}

std::vector<std::vector<Pebble>> read_spheres(const std::filesystem::path& file) {
  std::vector<std::vector<Pebble>> stones;
  std::map<std::int64_t, std::size_t> stone_of;
  const std::string text = read_file(file);
  int number = 0;
  for (std::size_t at = 0; at < text.size();) {
    const std::size_t end = std::min(text.find('\n', at), text.size());
    const auto v = numbers_of(std::string_view(text).substr(at, end - at), file, ++number);
    at = end + 1;
    if (v.empty()) continue;
    std::size_t stone = stones.size();
    if (v.size() == 5) stone = stone_of.try_emplace(static_cast<std::int64_t>(v[4]), stone).first->second;
    if (stone == stones.size()) stones.emplace_back();
    stones[stone].push_back({{v[0], v[1], v[2]}, v[3]});
  }
  if (stones.empty()) throw InputError(file.string() + ": there is no sphere in it");
  return stones;
}

/// A template in its principal frame, and where that frame lies in the given spheres' coordinates.
struct Fitted {
  ClumpTemplate shape;
  Pose frame;
};

Fitted template_of(const std::vector<Pebble>& spheres) {
  Vec3 centre = Vec3::Zero();
  double sum = 0;
  for (const Pebble& p : spheres) {
    const double v = std::pow(p.radius, 3);
    centre += v * p.centre;
    sum += v;
  }
  centre /= sum;
  Mat3 inertia = Mat3::Zero();
  for (const Pebble& p : spheres) {
    const double v = 4.0 / 3.0 * std::numbers::pi * std::pow(p.radius, 3);
    const Vec3 d = p.centre - centre;
    inertia += v * ((0.4 * p.radius * p.radius + d.squaredNorm()) * Mat3::Identity() - d * d.transpose());
  }
  const double volume = spheres.size() == 1 ? 4.0 / 3.0 * std::numbers::pi * sum : union_volume(spheres, 400);
  inertia *= volume / (4.0 / 3.0 * std::numbers::pi * sum);
  Mat3 axes = Mat3::Identity();
  Vec3 principal = inertia.diagonal();
  if (spheres.size() > 1) {
    const Eigen::SelfAdjointEigenSolver<Mat3> solver(inertia);
    axes = solver.eigenvectors();
    principal = solver.eigenvalues();
    if (axes.determinant() < 0) axes.col(0) = -axes.col(0);
  }
  std::vector<Pebble> local = spheres;
  for (Pebble& p : local) p.centre = axes.transpose() * (p.centre - centre);
  return {make_clump_template("bed", local, volume, principal), {centre, Quat(axes)}};
}

Vec3 mean_centre(const std::vector<Pebble>& spheres) {
  Vec3 sum = Vec3::Zero();
  for (const Pebble& p : spheres) sum += p.centre;
  return sum / static_cast<double>(spheres.size());
}

/// Rotation and shift that carry the spheres of one stone onto those of an equal one, listed in the same
/// order (Kabsch 1976).
Pose fit(const std::vector<Pebble>& from, const std::vector<Pebble>& to) {
  const Vec3 a = mean_centre(from), b = mean_centre(to);
  Mat3 covariance = Mat3::Zero();
  for (std::size_t k = 0; k < from.size(); ++k)
    covariance += (to[k].centre - b) * (from[k].centre - a).transpose();
  const Eigen::JacobiSVD<Mat3> svd(covariance, Eigen::ComputeFullU | Eigen::ComputeFullV);
  Vec3 signs = Vec3::Ones();
  if ((svd.matrixU() * svd.matrixV().transpose()).determinant() < 0) signs.z() = -1;
  const Mat3 turn = svd.matrixU() * signs.asDiagonal() * svd.matrixV().transpose();
  return {b - turn * a, Quat(turn)};
}

}  // namespace

void add_open_box(Simulation& sim, double side) {
  const auto wall = [&](const char* name, const Vec3& point, const Vec3& normal) {
    add_wall(sim, {make_plane_wall(name, side), 0, {}}, {point, Quat::FromTwoVectors(Vec3::UnitZ(), normal)});
  };
  wall("floor", {0, 0, 0}, Vec3::UnitZ());
  wall("left", {0, 0, 0}, Vec3::UnitX());
  wall("right", {side, 0, 0}, -Vec3::UnitX());
  wall("front", {0, 0, 0}, Vec3::UnitY());
  wall("back", {0, side, 0}, -Vec3::UnitY());
}

Simulation read_bed(const std::filesystem::path& file, double side, double density) {
  const auto stones = read_spheres(file);
  Simulation sim;
  sim.model.materials = {{"stone", 2e7, 2e7, 0.5, 0, density}};
  sim.model.pairs = PairTable(sim.model.materials, LawKind::linear, {});
  add_open_box(sim, side);
  std::map<std::vector<double>, std::pair<int, std::size_t>> known;  // radii -> template, first stone
  std::vector<Pose> frames;
  for (std::size_t s = 0; s < stones.size(); ++s) {
    if (stones[s].size() == 1) {
      if (sim.model.templates.empty()) sim.model.templates.push_back(make_ball_template(1.0));
      add_clump(sim.model, sim.state, 0, stones[s][0].radius, 0, {stones[s][0].centre, Quat::Identity()});
      continue;
    }
    std::vector<double> radii;
    for (const Pebble& p : stones[s]) radii.push_back(p.radius);
    const auto [entry, is_new] = known.try_emplace(radii, static_cast<int>(sim.model.templates.size()), s);
    if (is_new) {
      Fitted fitted = template_of(stones[s]);
      frames.push_back(fitted.frame);
      sim.model.templates.push_back(std::move(fitted.shape));
    }
    const auto& [shape, first] = entry->second;
    const Pose moved = fit(stones[first], stones[s]);
    const Pose& frame = frames[static_cast<std::size_t>(shape)];
    add_clump(sim.model, sim.state, shape, 1.0, 0,
              {moved.to_world(frame.position), (moved.orientation * frame.orientation).normalized()});
  }
  sim.changed();
  return sim;
}

}  // namespace trackbed
