#include "fem/beam.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <stdexcept>
#include <utility>

namespace trackbed::fem {
namespace {

using Eigen::Matrix4d;
using Eigen::Vector4d;

struct GaussPoint {
  double xi, weight;
};

/// Four points on 0..1: exact up to degree 7, the mass matrix has 6.
std::array<GaussPoint, 4> gauss_points() {
  const double inner = std::sqrt(3.0 / 7 - 2.0 / 7 * std::sqrt(1.2)),
               outer = std::sqrt(3.0 / 7 + 2.0 / 7 * std::sqrt(1.2));
  const double of_inner = (18 + std::sqrt(30.0)) / 72, of_outer = (18 - std::sqrt(30.0)) / 72;
  return {{{0.5 - 0.5 * outer, of_outer},
           {0.5 - 0.5 * inner, of_inner},
           {0.5 + 0.5 * inner, of_inner},
           {0.5 + 0.5 * outer, of_outer}}};
}

/// 12 E I / (kappa G A L^2): how much shearing adds to bending.
double shear_ratio(const BeamSection& s, double length) {
  if (s.shear_area <= 0) return 0;
  const double shear_modulus = s.young / (2 * (1 + s.poisson));
  return 12 * s.young * s.second_moment / (shear_modulus * s.shear_area * length * length);
}

Matrix4d bending_stiffness(const BeamSection& s, double length) {
  const double l = length, ratio = shear_ratio(s, l);
  Matrix4d k;
  k << 12, 6 * l, -12, 6 * l,                                   //
      6 * l, (4 + ratio) * l * l, -6 * l, (2 - ratio) * l * l,  //
      -12, -6 * l, 12, -6 * l,                                  //
      6 * l, (2 - ratio) * l * l, -6 * l, (4 + ratio) * l * l;
  return s.young * s.second_moment / (l * l * l * (1 + ratio)) * k;
}

void add_block(std::vector<Eigen::Triplet<double>>& entries, const std::array<Index, 4>& where,
               const Matrix4d& block) {
  for (int i = 0; i < 4; ++i)
    for (int j = 0; j < 4; ++j)
      if (where[static_cast<std::size_t>(i)] >= 0 && where[static_cast<std::size_t>(j)] >= 0)
        entries.emplace_back(where[static_cast<std::size_t>(i)], where[static_cast<std::size_t>(j)],
                             block(i, j));
}

}  // namespace

BeamShape beam_shape(const BeamSection& section, double length, double xi) {
  const double p = shear_ratio(section, length), l = length, x2 = xi * xi, x3 = x2 * xi;
  BeamShape shape;
  shape.deflection << 1 - 3 * x2 + 2 * x3 + p * (1 - xi), l * (xi - 2 * x2 + x3 + p / 2 * (xi - x2)),
      3 * x2 - 2 * x3 + p * xi, l * (x3 - x2 - p / 2 * (xi - x2));
  shape.slope << 6 * (x2 - xi) / l, 1 - 4 * xi + 3 * x2 + p * (1 - xi), 6 * (xi - x2) / l,
      3 * x2 - 2 * xi + p * xi;
  shape.deflection /= 1 + p;
  shape.slope /= 1 + p;
  return shape;
}

std::vector<double> even_nodes(double a, double b, int parts) {
  std::vector<double> nodes;
  for (int k = 0; k <= parts; ++k) nodes.push_back(a + (b - a) * k / parts);
  return nodes;
}

Beam::Beam(const BeamSection& section, std::vector<double> nodes, BeamEnd left, BeamEnd right)
    : section_(section), nodes_(std::move(nodes)) {
  if (nodes_.size() < 2 || std::ranges::adjacent_find(nodes_, std::greater_equal<>()) != nodes_.end())
    throw std::invalid_argument("the nodes of a beam ascend");
  if (section.young <= 0 || section.second_moment <= 0 || section.area <= 0 || section.density <= 0)
    throw std::invalid_argument("a beam's section and material are above zero");
  const auto held = [](BeamEnd end, bool slope) {
    return end == BeamEnd::clamped || (slope ? end == BeamEnd::guided : end == BeamEnd::simple);
  };
  for (std::size_t n = 0; n < nodes_.size(); ++n)
    for (const bool slope : {false, true}) {
      const bool is_held = (n == 0 && held(left, slope)) || (n + 1 == nodes_.size() && held(right, slope));
      coordinate_.push_back(is_held ? -1 : free_++);
    }
}

Structure<SparseMatrix> Beam::structure(double gravity, const Foundation& foundation) const {
  std::vector<Eigen::Triplet<double>> mass, stiffness, damping, ports;
  VectorXd load = VectorXd::Zero(free_);
  for (std::size_t e = 0; e + 1 < nodes_.size(); ++e) {
    const double length = nodes_[e + 1] - nodes_[e];
    const std::array<Index, 4> where{coordinate_[2 * e], coordinate_[2 * e + 1], coordinate_[2 * e + 2],
                                     coordinate_[2 * e + 3]};
    Matrix4d m = Matrix4d::Zero(), ground = Matrix4d::Zero();
    Vector4d weight = Vector4d::Zero();
    const double rotary = section_.shear_area > 0 ? section_.density * section_.second_moment : 0;
    for (const auto& [xi, share] : gauss_points()) {
      const auto [w, slope] = beam_shape(section_, length, xi);
      m += share * length *
           (section_.density * section_.area * w * w.transpose() + rotary * slope * slope.transpose());
      ground += share * length * w * w.transpose();
      weight -= share * length * section_.density * section_.area * gravity * w;
    }
    const Matrix4d k = bending_stiffness(section_, length);
    add_block(mass, where, m);
    add_block(stiffness, where, k + foundation.stiffness * ground);
    add_block(damping, where, section_.damping * k + foundation.damping * ground);
    for (std::size_t i = 0; i < 4; ++i)
      if (where[i] >= 0) load(where[i]) += weight(static_cast<Index>(i));
  }
  for (Index k = 0; k < free_; ++k) ports.emplace_back(k, k, 1.0);
  const auto matrix = [&](const std::vector<Eigen::Triplet<double>>& entries) {
    SparseMatrix made(free_, free_);
    made.setFromTriplets(entries.begin(), entries.end());
    return made;
  };
  return {matrix(mass), matrix(damping), matrix(stiffness), load, matrix(ports)};
}

std::vector<LinkEnd> Beam::at(double x, Index first_port, double weight) const {
  if (!(x >= nodes_.front() && x <= nodes_.back())) throw std::out_of_range("beyond the end of a beam");
  auto e = static_cast<std::size_t>(std::ranges::upper_bound(nodes_, x) - nodes_.begin());
  e = std::min(e, nodes_.size() - 1) - 1;
  const double length = nodes_[e + 1] - nodes_[e];
  const Vector4d w = beam_shape(section_, length, (x - nodes_[e]) / length).deflection;
  std::vector<LinkEnd> ends;
  for (std::size_t i = 0; i < 4; ++i) {
    const double share = weight * w(static_cast<Index>(i));
    if (coordinate_[2 * e + i] >= 0 && share != 0)
      ends.push_back({first_port + coordinate_[2 * e + i], share});
  }
  return ends;
}

}  // namespace trackbed::fem
