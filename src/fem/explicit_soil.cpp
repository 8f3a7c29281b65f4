#include "fem/explicit_soil.h"

#include <fmt/format.h>

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <vector>

#include "base/error.h"
#include "fem/soil_stencil.h"

namespace trackbed::fem {

namespace {

/// Greatest frequency of a free element with lumped mass [1/s]: no mesh of such elements has a greater one,
/// since its Rayleigh quotient is a mean of those of its elements (Irons; Belytschko, Liu & Moran,
/// section 6.2).
double greatest_frequency(const Soil& soil) {
  const HexNodes cube =
      make_block(Vec3::Zero(), Vec3::Constant(soil.input.element_size), 1, 1, 1).cell_nodes(0);
  double w2 = 0;
  for (const Elastic& solid : soil.materials) {
    const double mass = hex_lumped_mass(cube, solid.density)[0];
    const HexMatrix k = hex_stiffness(cube, solid, soil.input.element) / mass;
    w2 = std::max(w2, Eigen::SelfAdjointEigenSolver<HexMatrix>(k, Eigen::EigenvaluesOnly).eigenvalues()[23]);
  }
  return std::sqrt(w2);
}

/// next = g (f - K u) + h u + q u_before, of one node and axis; all zero when held.
struct Update {
  double g = 0, h = 0, q = 0;
};

Update make_update(double mass, double damping, double dt) {
  const double m = mass / (dt * dt), c = damping / (2 * dt), g = 1 / (m + c);
  return {g, 2 * m * g, (c - m) * g};
}

}  // namespace

struct ExplicitSoil::Parts {
  Soil soil;
  SoilStencil stencil;
  double dt = 0;
  std::vector<double> u, before;                          // u(n), u(n-1)
  std::vector<double> moved;                              // u(n) + b velocity, with stiffness damping
  std::vector<int> footing_row;                           // of each section node: row of the footings, or -1
  std::vector<std::array<Update, 3>> first, inner, last;  // of each section node
  Eigen::VectorXd displacement, velocity;

  explicit Parts(const Soil& s) : soil(s), stencil(s) {
    if (soil.planes < 3) throw InputError("the ground is shorter than two elements");
    footing_row.assign(static_cast<std::size_t>(soil.section_size()), -1);
    for (int row = 0; row < soil.nodes_across; ++row)
      footing_row[static_cast<std::size_t>(soil.footing_section_nodes[static_cast<std::size_t>(row)])] = row;
    u.assign(stencil.size(), 0.0);
    before = u;
    if (soil.input.stiffness_damping > 0) moved = u;
  }

  /// Calls visit(plane, force) for the nodes of the row of footings at a section node.
  template <class Visit>
  void for_footing_nodes(int section_node, Visit visit) const {
    const int row = footing_row[static_cast<std::size_t>(section_node)];
    if (row < 0) return;
    for (int f = 0; f < soil.footings(); ++f)
      for (int a = 0; a < soil.nodes_along; ++a)
        visit(soil.first_plane[static_cast<std::size_t>(f)] + a,
              f * soil.nodes_per_footing() + row * soil.nodes_along + a);
  }

  void read_footings() {
    displacement.resize(soil.footings() * soil.nodes_per_footing());
    velocity.resize(displacement.size());
    for (int s : soil.footing_section_nodes) {
      const double *now = stencil.row(u.data(), s, 2), *then = stencil.row(before.data(), s, 2);
      for_footing_nodes(s, [&](int plane, int entry) {
        displacement[entry] = now[plane];
        velocity[entry] = (now[plane] - then[plane]) / dt;
      });
    }
  }

  void make_updates() {
    const auto rows = static_cast<std::size_t>(soil.section_size());
    auto of_plane = [&](int plane, std::vector<std::array<Update, 3>>& updates) {
      updates.assign(rows, {});
      for (std::size_t s = 0; s < rows; ++s) {
        const int node = static_cast<int>(s);
        const double mass = soil.mass(plane, node);
        const Vec3 dashpot = soil.dashpot(plane, node);
        for (int axis = 0; axis < 3; ++axis)
          if (!soil.is_held(plane, node, axis))
            updates[s][static_cast<std::size_t>(axis)] =
                make_update(mass, dashpot[axis] + soil.input.mass_damping * mass, dt);
      }
    };
    of_plane(0, first);
    of_plane(1, inner);
    of_plane(soil.planes - 1, last);
  }

  void step_row(int s, const Eigen::VectorXd& forces, std::vector<double>& scratch) {
    const int planes = soil.planes;
    scratch.resize(static_cast<std::size_t>(3 * planes));
    const std::array<double*, 3> k{scratch.data(), scratch.data() + planes, scratch.data() + 2 * planes};
    stencil.force(moved.empty() ? u.data() : moved.data(), s, k);
    for_footing_nodes(s, [&](int plane, int entry) { k[2][plane] -= forces[entry]; });
    for (int axis = 0; axis < 3; ++axis) {
      const auto a = static_cast<std::size_t>(axis);
      const double *now = stencil.row(u.data(), s, axis), *force = k[a];
      double* next = stencil.row(before.data(), s, axis);
      auto update = [&](const Update& c, int i) {
        next[i] = (c.h * now[i] + c.q * next[i]) - c.g * force[i];
      };
      const auto node = static_cast<std::size_t>(s);
      update(first[node][a], 0);
      const Update c = inner[node][a];
#pragma omp simd
      for (int i = 1; i < planes - 1; ++i) next[i] = (c.h * now[i] + c.q * next[i]) - c.g * force[i];
      update(last[node][a], planes - 1);
    }
  }

  void step(const Eigen::VectorXd& forces) {
    const int rows = soil.section_size();
    const double lag = soil.input.stiffness_damping / dt;
    const auto size = static_cast<std::ptrdiff_t>(u.size());
#pragma omp parallel
    {
      if (!moved.empty()) {
#pragma omp for schedule(static)
        for (std::ptrdiff_t i = 0; i < size; ++i) {
          const auto n = static_cast<std::size_t>(i);
          moved[n] = u[n] + lag * (u[n] - before[n]);
        }
      }
      std::vector<double> scratch;
#pragma omp for schedule(dynamic, 4)
      for (int s = 0; s < rows; ++s) step_row(s, forces, scratch);
    }
    u.swap(before);
    read_footings();
  }

  // Rest by conjugate gradients. Sums are made row by row, then over rows in their order.

  template <class OfRow>
  double sum_rows(OfRow of_row) const {
    const int rows = soil.section_size();
    std::vector<double> sums(static_cast<std::size_t>(rows));
#pragma omp parallel for schedule(dynamic, 4)
    for (int s = 0; s < rows; ++s) sums[static_cast<std::size_t>(s)] = of_row(s);
    double sum = 0;
    for (double part : sums) sum += part;
    return sum;
  }

  bool is_held(int s, int axis, int plane) const {
    const auto& updates = plane == 0 ? first : plane == soil.planes - 1 ? last : inner;
    return updates[static_cast<std::size_t>(s)][static_cast<std::size_t>(axis)].g == 0;
  }

  /// out = K p of one section node, nothing where held; returns p . K p.
  double apply_row(const std::vector<double>& p, int s, std::vector<double>& out) const {
    const std::array<double*, 3> k{stencil.row(out.data(), s, 0), stencil.row(out.data(), s, 1),
                                   stencil.row(out.data(), s, 2)};
    stencil.force(p.data(), s, k);
    double sum = 0;
    for (int axis = 0; axis < 3; ++axis) {
      double* force = k[static_cast<std::size_t>(axis)];
      for (int end : {0, 1, soil.planes - 1}) {
        if (!is_held(s, axis, end)) continue;
        if (end == 1)
          std::fill(force + 1, force + soil.planes - 1, 0.0);
        else
          force[end] = 0;
      }
      const double* direction = stencil.row(p.data(), s, axis);
      for (int i = 0; i < soil.planes; ++i) sum += direction[i] * force[i];
    }
    return sum;
  }

  /// Of the rows of one section node: x += a p, r -= a q; returns r . r / diag K.
  double advance_row(int s, double a, const std::vector<double>& p, const std::vector<double>& q,
                     std::vector<double>& r) {
    double sum = 0;
    for (int axis = 0; axis < 3; ++axis) {
      double *x = stencil.row(u.data(), s, axis), *rest = stencil.row(r.data(), s, axis);
      const double *direction = stencil.row(p.data(), s, axis), *force = stencil.row(q.data(), s, axis);
      double part = 0;
      for (int i = 0; i < soil.planes; ++i) {
        x[i] += a * direction[i];
        rest[i] -= a * force[i];
        part += rest[i] * rest[i];
      }
      sum += part / stencil.diagonal(s, axis);
    }
    return sum;
  }

  void turn_row(int s, double b, const std::vector<double>& r, std::vector<double>& p) const {
    for (int axis = 0; axis < 3; ++axis) {
      const double *rest = stencil.row(r.data(), s, axis), inverse = 1 / stencil.diagonal(s, axis);
      double* direction = stencil.row(p.data(), s, axis);
      for (int i = 0; i < soil.planes; ++i) direction[i] = inverse * rest[i] + b * direction[i];
    }
  }

  void find_rest(const Eigen::VectorXd& forces) {
    std::vector<double> r(u.size(), 0.0), p(u.size(), 0.0), q(u.size(), 0.0);
    std::fill(u.begin(), u.end(), 0.0);
    for (int s : soil.footing_section_nodes) {
      double* rest = stencil.row(r.data(), s, 2);
      for_footing_nodes(s, [&](int plane, int entry) {
        if (!is_held(s, 2, plane)) rest[plane] += forces[entry];
      });
    }
    double rr = sum_rows([&](int s) { return advance_row(s, 0, p, q, r); }), rr_before = rr;
    const double enough = 1e-18 * rr;  // of squares
    double b = 0;
    for (int n = 0; rr > enough; ++n) {
      if (n == 10000) throw RunError("the ground under its load finds no rest; is it held?");
      const int rows = soil.section_size();
#pragma omp parallel for schedule(dynamic, 4)
      for (int s = 0; s < rows; ++s) turn_row(s, b, r, p);
      const double a = rr / sum_rows([&](int s) { return apply_row(p, s, q); });
      rr_before = rr;
      rr = sum_rows([&](int s) { return advance_row(s, a, p, q, r); });
      b = rr / rr_before;
    }
    before = u;
  }
};

ExplicitSoil::ExplicitSoil(const Soil& soil) : parts_(new Parts(soil)) {}
ExplicitSoil::~ExplicitSoil() = default;

double stable_time_step(const Soil& soil) {
  const double w = greatest_frequency(soil), ratio = soil.input.stiffness_damping * w / 2;
  return 2 / w * (std::sqrt(1 + ratio * ratio) - ratio);
}

void ExplicitSoil::start(const Eigen::VectorXd& forces, double dt) {
  const double longest = stable_time_step(parts_->soil);
  if (!(dt > 0) || dt > longest)
    throw RunError(fmt::format("a time step of {:.4g} ms is too long for the ground: {:.4g} ms at most",
                               1e3 * dt, 1e3 * longest));
  parts_->dt = dt;
  parts_->make_updates();
  parts_->find_rest(forces);
  parts_->read_footings();
}

void ExplicitSoil::step(const Eigen::VectorXd& forces) {
  parts_->step(forces);
}

const Eigen::VectorXd& ExplicitSoil::displacement() const {
  return parts_->displacement;
}
const Eigen::VectorXd& ExplicitSoil::velocity() const {
  return parts_->velocity;
}

}  // namespace trackbed::fem
