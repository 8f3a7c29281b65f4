#include "fem/reduced_soil.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <vector>

#include "fem/blas.h"
#include "fem/ritz.h"
#include "fem/soil_columns.h"

namespace trackbed::fem {

namespace {

constexpr double gravity_acceleration = 9.81;  // [m/s2]

/// Galerkin's matrices of all columns, before they are made orthonormal.
class Projection {
 public:
  Projection(const Soil& soil, const ColumnSets& columns)
      : soil_(soil),
        columns_(columns),
        planes_(static_cast<int>(columns.sets.front().values.rows()) / (3 * soil.section_size())),
        footings_(soil.footings()),
        masses_(masses_of(soil, 0, soil.planes)),
        dashpots_(dashpots_of(soil, 0, soil.planes)),
        has_dashpots_(!dashpots_.isZero(0)) {
    for (int f = 0; f < footings_; ++f) at_.push_back(at_.back() + set(f).values.cols());
    const Eigen::Index n = at_.back();
    mass.setZero(n, n);
    stiffness.setZero(n, n);
    dashpots.setZero(has_dashpots_ ? n : 0, has_dashpots_ ? n : 0);
    nodes.setZero(footings_ * soil.nodes_per_footing(), n);
    gravity.setZero(n);
    project_pairs();
    for (int f = 0; f < footings_; ++f) project(f);
  }

  Eigen::MatrixXd mass, stiffness, dashpots, nodes;
  Eigen::VectorXd gravity;

 private:
  struct Block {
    Eigen::MatrixXd mass, stiffness, dashpots;
  };
  int begin(int f) const { return columns_.first_plane[static_cast<std::size_t>(f)]; }
  /// The columns of footing f among all.
  Eigen::Index at(int f) const { return at_[static_cast<std::size_t>(f)]; }
  Eigen::Index count(int f) const { return set(f).values.cols(); }
  int set_index(int f) const { return columns_.set_of[static_cast<std::size_t>(f)]; }
  const SoilColumns& set(int f) const { return columns_.sets[static_cast<std::size_t>(set_index(f))]; }

  /// What the columns of j do to those of i. A few planes at a time stay in a core's cache.
  Block pair(int i, int j) const {
    constexpr int planes_at_once = 4;
    const int from = std::max(begin(i), begin(j)), to = std::min(begin(i), begin(j)) + planes_;
    const Eigen::Index node = 3 * soil_.section_size();
    Block b;
    for (Eigen::MatrixXd* m : {&b.mass, &b.stiffness, &b.dashpots}) m->setZero(count(i), count(j));
    Eigen::MatrixXd weighted;
    for (int p = from; p < to; p += planes_at_once) {
      const Eigen::Index rows = std::min(planes_at_once, to - p) * node;
      auto part = [&](const Eigen::MatrixXd& m, int f) { return m.middleRows((p - begin(f)) * node, rows); };
      const auto vi = part(set(i).values, i), vj = part(set(j).values, j);
      b.stiffness.noalias() += vi.transpose() * part(set(j).forces, j);
      weighted = masses_.segment(p * node, rows).asDiagonal() * vj;
      b.mass.noalias() += vi.transpose() * weighted;
      if (dashpots_.segment(p * node, rows).isZero(0)) continue;
      weighted = dashpots_.segment(p * node, rows).asDiagonal() * vj;
      b.dashpots.noalias() += vi.transpose() * weighted;
    }
    return b;
  }

  /// Pairs that are others shifted are worked out once; those of dashpots only while no end of the soil is in
  /// them.
  void project_pairs() {
    struct Shared {
      int i, j;
      std::vector<std::array<int, 2>> others;
    };
    std::map<std::array<int, 3>, Shared> pairs;
    for (int j = 0; j < footings_; ++j)
      for (int i = 0; i <= j; ++i) {
        if (std::abs(begin(i) - begin(j)) >= planes_) continue;
        const auto at =
            pairs.try_emplace({set_index(i), set_index(j), begin(j) - begin(i)}, Shared{i, j, {}}).first;
        at->second.others.push_back({i, j});
      }
    std::vector<const Shared*> list;
    for (const auto& [key, shared] : pairs) list.push_back(&shared);
#pragma omp parallel for schedule(dynamic)
    for (std::size_t p = 0; p < list.size(); ++p) {
      const Block b = pair(list[p]->i, list[p]->j);
      for (const auto& [i, j] : list[p]->others) {
        put(mass, b.mass, i, j);
        put(stiffness, b.stiffness, i, j);
        if (has_dashpots_) put(dashpots, b.dashpots, i, j);
      }
    }
  }

  void put(Eigen::MatrixXd& to, const Eigen::MatrixXd& block, int i, int j) const {
    if (i == j) {
      to.block(at(i), at(i), count(i), count(i)) = (block + block.transpose()) / 2;
    } else {
      to.block(at(i), at(j), count(i), count(j)) = block;
      to.block(at(j), at(i), count(j), count(i)) = block.transpose();
    }
  }

  /// What footings see of the columns of f, and their weight.
  void project(int f) {
    const Eigen::MatrixXd& values = set(f).values;
    const int size = soil_.section_size();
    for (int g = 0; g < footings_; ++g) {
      const int plane = soil_.first_plane[static_cast<std::size_t>(g)] - begin(f);
      for (int row = 0; row < soil_.nodes_across; ++row)
        for (int a = 0; a < soil_.nodes_along; ++a) {
          if (plane + a < 0 || plane + a >= planes_) continue;
          const int node = (plane + a) * size + soil_.footing_section_nodes[static_cast<std::size_t>(row)];
          nodes.row(g * soil_.nodes_per_footing() + row * soil_.nodes_along + a).segment(at(f), count(f)) =
              values.row(3 * node + 2);
        }
    }
    for (int node = 0; node < planes_ * size; ++node)
      gravity.segment(at(f), count(f)) -= gravity_acceleration * masses_[3 * (begin(f) * size + node) + 2] *
                                          values.row(3 * node + 2).transpose();
  }

  const Soil& soil_;
  const ColumnSets& columns_;
  std::vector<Eigen::Index> at_ = {0};
  int planes_, footings_;
  Eigen::VectorXd masses_, dashpots_;  // of all planes
  bool has_dashpots_;
};

}  // namespace

ReducedSoil reduce(const Soil& soil, const ReductionInput& input) {
  use_one_blas_thread();
  const ColumnSets columns = make_columns(soil, input);
  Projection all(soil, columns);
  const auto [values, modes] = ritz_modes(std::move(all.mass), all.stiffness);
  ReducedSoil reduced;
  reduced.stiffness = values;
  reduced.nodes = all.nodes * modes;
  reduced.gravity = modes.transpose() * all.gravity;
  if (all.dashpots.size() > 0)
    reduced.damping = modes.transpose() * (all.dashpots * modes).eval();
  else
    reduced.damping.setZero(modes.cols(), modes.cols());
  reduced.damping.diagonal() += (soil.input.stiffness_damping * reduced.stiffness).array().matrix();
  reduced.damping.diagonal().array() += soil.input.mass_damping;
  return reduced;
}

}  // namespace trackbed::fem
