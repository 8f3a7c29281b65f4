#include "lab/bed_file.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <map>
#include <numbers>
#include <string_view>
#include <utility>

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

/// Largest distance of a sphere from where the pose puts it [m].
double misfit(const std::vector<Pebble>& from, const std::vector<Pebble>& to, const Pose& pose) {
  double most = 0;
  for (std::size_t k = 0; k < from.size(); ++k)
    most = std::max(most, (pose.to_world(from[k].centre) - to[k].centre).norm());
  return most;
}

/// A stone as a template, its scale and its pose.
struct Placed {
  int shape = 0;
  double scale = 1;
  Pose pose;
};

/// The templates of a bed: one for all balls, one for all clumps that are alike.
class Shapes {
 public:
  explicit Shapes(std::vector<ClumpTemplate>& templates) : templates_(templates) {}

  Placed place(const std::vector<Pebble>& stone) {
    return stone.size() == 1 ? place_ball(stone[0]) : place_clump(stone);
  }

 private:
  struct Known {
    int shape;
    std::vector<Pebble> first;  // the stone that it was made of
    Pose frame;                 // of the template in that stone's coordinates
  };

  int add(ClumpTemplate shape) {
    templates_.push_back(std::move(shape));
    return static_cast<int>(templates_.size()) - 1;
  }

  Placed place_ball(const Pebble& ball) {
    if (ball_ < 0) ball_ = add(make_ball_template(1.0));
    return {ball_, ball.radius, {ball.centre, Quat::Identity()}};
  }

  Placed place_clump(const std::vector<Pebble>& stone) {
    constexpr double tolerance = 0.01;  // of the smallest radius: files are written with few digits
    std::vector<double> radii;
    for (const Pebble& p : stone) radii.push_back(p.radius);
    std::vector<Known>& alike = known_[radii];
    for (const Known& known : alike) {
      const Pose moved = fit(known.first, stone);
      if (misfit(known.first, stone, moved) <= tolerance * *std::ranges::min_element(radii))
        return placed(known, moved);
    }
    Fitted fitted = template_of(stone);
    alike.push_back({add(std::move(fitted.shape)), stone, fitted.frame});
    return placed(alike.back(), fit(stone, stone));
  }

  /// `moved` carries the first stone onto this one.
  static Placed placed(const Known& known, const Pose& moved) {
    const Quat turn = (moved.orientation * known.frame.orientation).normalized();
    return {known.shape, 1.0, {moved.to_world(known.frame.position), turn}};
  }

  std::vector<ClumpTemplate>& templates_;
  int ball_ = -1;
  std::map<std::vector<double>, std::vector<Known>> known_;  // by their radii
};

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
  Shapes shapes(sim.model.templates);
  for (const std::vector<Pebble>& stone : stones) {
    const Placed placed = shapes.place(stone);
    add_clump(sim.model, sim.state, placed.shape, placed.scale, 0, placed.pose);
  }
  sim.changed();
  return sim;
}

}  // namespace trackbed
