#include "fem/soil_columns.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "base/error.h"
#include "fem/assembly.h"
#include "fem/ritz.h"
#include "fem/sparse_cholesky.h"

namespace trackbed::fem {

namespace {

/// Krylov columns of a pressure shape: so many about rest, then so many about loads that grow with exp(s t).
struct Levels {
  int at_rest, in_blows;
  double s;  // [1/s]
  int count() const { return at_rest + in_blows; }
};

/// A run of planes of the soil, held at its cuts.
class Window {
 public:
  Window(const Soil& soil, int first_plane, int planes)
      : soil_(soil),
        first_(first_plane),
        planes_(planes),
        mesh_(extrude(soil.section, 0, soil.input.element_size, planes)),
        free_(planes * soil.section_size()),
        mass_(masses_of(soil, first_plane, planes)) {
    hold();
  }

  /// The columns of footings whose windows this is.
  std::vector<SoilColumns> columns(const std::vector<int>& footings, const Levels& krylov) const {
    std::vector<SoilColumns> sets;
    for (const MassBasis& basis : bases_of(footings, krylov)) {
      const int footing = footings[sets.size()];
      sets.push_back({basis.columns(), {}, soil_.first_plane[static_cast<std::size_t>(footing)] - first_});
    }
    Freedoms all(free_.nodes());  // held ones too
    all.number();
    const SparseMatrix stiffness = stiffness_of(all);
#pragma omp parallel for schedule(dynamic)
    for (std::size_t f = 0; f < sets.size(); ++f) sets[f].forces = stiffness * sets[f].values;
    return sets;
  }

 private:
  void hold() {
    for (int p = 0; p < planes_; ++p) {
      const int plane = first_ + p;
      const bool cut = (p == 0 && plane > 0) || (p == planes_ - 1 && plane < soil_.planes - 1);
      for (int s = 0; s < soil_.section_size(); ++s)
        for (int axis = 0; axis < 3; ++axis)
          if (cut || soil_.is_held(plane, s, axis)) free_.hold(p * soil_.section_size() + s, axis);
    }
    free_.number();
  }

  SparseMatrix stiffness_of(const Freedoms& freedoms) const {
    return assemble_stiffness(mesh_, soil_.materials, soil_.input.element, freedoms);
  }

  /// Krylov shapes of each footing's pressures: (K + s^2 M)^-1 M of those before, s = 0 at first.
  std::vector<MassBasis> bases_of(const std::vector<int>& footings, const Levels& krylov) const {
    const Eigen::Index shapes = soil_.shapes.cols();
    const MassBasis empty([&](const Eigen::VectorXd& v) -> Eigen::VectorXd { return mass_.cwiseProduct(v); },
                          mass_.size(), shapes*(1 + krylov.count()));
    std::vector<MassBasis> bases(footings.size(), empty);
    Eigen::MatrixXd right(free_.size(), shapes * static_cast<Eigen::Index>(footings.size()));
    right.setZero();
    for (std::size_t f = 0; f < footings.size(); ++f)
      press(footings[f], right.middleCols(static_cast<Eigen::Index>(f) * shapes, shapes));
    SparseMatrix stiffness = stiffness_of(free_);
    SparseCholesky factor(stiffness, free_);
    for (int level = 0; level <= krylov.count(); ++level) {
      if (level == krylov.at_rest + 1) {
        stiffness.diagonal() += krylov.s * krylov.s * to_free(mass_);
        factor.refactor(stiffness);
      }
      const Eigen::MatrixXd solution = factor.solve(right);
      bool is_new = true;
#pragma omp parallel for schedule(dynamic) reduction(&& : is_new)
      for (std::size_t f = 0; f < footings.size(); ++f) {
        const Eigen::Index at = static_cast<Eigen::Index>(f) * shapes;
        for (Eigen::Index c = at; c < at + shapes && is_new; ++c) {
          is_new = bases[f].add(to_nodes(solution.col(c), free_));
          if (is_new) right.col(c) = to_free(mass_.cwiseProduct(bases[f].columns().rightCols<1>()));
        }
      }
      if (!is_new)
        throw InputError(
            fmt::format("krylov is {}; the mesh has no more shapes than {}", krylov.count(), level));
    }
    return bases;
  }

  void press(int footing, Eigen::Ref<Eigen::MatrixXd> right) const {
    const int offset = first_ * soil_.section_size();
    for (int row = 0; row < soil_.nodes_across; ++row)
      for (int a = 0; a < soil_.nodes_along; ++a) {
        const int f = free_(soil_.node(footing, a, row) - offset, 2);
        if (f >= 0) right.row(f) = soil_.shape_forces.row(row * soil_.nodes_along + a);
      }
  }

  Eigen::VectorXd to_free(const Eigen::VectorXd& all) const {
    Eigen::VectorXd v(free_.size());
    for (int n = 0; n < free_.nodes(); ++n)
      for (int axis = 0; axis < 3; ++axis)
        if (free_(n, axis) >= 0) v[free_(n, axis)] = all[3 * n + axis];
    return v;
  }

  const Soil& soil_;
  int first_, planes_;
  HexMesh mesh_;
  Freedoms free_;
  Eigen::VectorXd mass_;
};

template <class OfNode>
Eigen::VectorXd of_planes(const Soil& soil, int first_plane, int planes, OfNode of_node) {
  Eigen::VectorXd v(3 * planes * soil.section_size());
  for (int p = 0; p < planes; ++p)
    for (int s = 0; s < soil.section_size(); ++s)
      v.segment<3>(3 * (p * soil.section_size() + s)) = of_node(first_plane + p, s);
  return v;
}

/// Where the window of each footing begins; all have the same number of planes.
struct Windows {
  int planes;
  std::vector<int> first_plane;
};

Windows place_windows(const Soil& soil, double length) {
  const int elements = static_cast<int>(std::ceil(length / soil.input.element_size - 1e-9));
  if (elements < soil.nodes_along + 1)
    throw InputError(fmt::format("window is {} m; it must be longer than a sleeper is wide", length));
  Windows w{std::min(elements + 1, soil.planes), {}};
  for (int plane : soil.first_plane) {
    const int begin = plane - (w.planes - soil.nodes_along) / 2;
    w.first_plane.push_back(std::clamp(begin, 0, soil.planes - w.planes));
  }
  return w;
}

}  // namespace

Eigen::VectorXd masses_of(const Soil& soil, int first_plane, int planes) {
  return of_planes(soil, first_plane, planes,
                   [&](int p, int s) { return Vec3(Vec3::Constant(soil.mass(p, s))); });
}

Eigen::VectorXd dashpots_of(const Soil& soil, int first_plane, int planes) {
  return of_planes(soil, first_plane, planes, [&](int p, int s) { return soil.dashpot(p, s); });
}

ColumnSets make_columns(const Soil& soil, const ReductionInput& input) {
  for (int krylov : {input.krylov, input.krylov_at_free_end})
    if (krylov < 0) throw InputError(fmt::format("krylov is {}; it must be 0 or more", krylov));
  if (input.blow_frequency < 0)
    throw InputError(fmt::format("blow_frequency is {} Hz; it must be 0 or more", input.blow_frequency));
  const Windows windows = place_windows(soil, input.window);
  ColumnSets result{{}, std::vector<int>(static_cast<std::size_t>(soil.footings())), windows.first_plane};
  const int last = soil.planes - windows.planes;
  auto add_window = [&](int first_plane, const std::vector<int>& footings, const Levels& krylov) {
    if (footings.empty()) return;
    for (SoilColumns& set : Window(soil, first_plane, windows.planes).columns(footings, krylov))
      result.sets.push_back(std::move(set));
  };
  // Footings that share the window at an end have columns of their own there, the others those of the first
  // of them.
  std::vector<int> at_start, at_end, between;
  for (int f = 0; f < soil.footings(); ++f) {
    const int begin = windows.first_plane[static_cast<std::size_t>(f)];
    (begin == 0 ? at_start : begin == last ? at_end : between).push_back(f);
  }
  const Levels inside{input.krylov, 0, 0};
  auto levels_at = [&](Support end) {
    if (end != Support::free) return inside;
    const int at_rest = input.blow_frequency > 0 ? std::min(input.krylov, input.krylov_at_free_end)
                                                 : input.krylov_at_free_end;
    return Levels{at_rest, input.krylov_at_free_end - at_rest, 2 * M_PI * input.blow_frequency};
  };
  int sets = 0;
  for (int f : at_start) result.set_of[static_cast<std::size_t>(f)] = sets++;
  const Levels at_first = levels_at(soil.input.start), at_last = levels_at(soil.input.end);
  add_window(0, at_start, last == 0 && at_last.count() > at_first.count() ? at_last : at_first);
  for (int f : at_end) result.set_of[static_cast<std::size_t>(f)] = sets++;
  add_window(last, at_end, at_last);
  for (int f : between) result.set_of[static_cast<std::size_t>(f)] = sets;
  if (!between.empty())
    add_window(windows.first_plane[static_cast<std::size_t>(between.front())], {between.front()}, inside);
  return result;
}

}  // namespace trackbed::fem
