// The stiffness of an extruded soil, never assembled: rows of a few stencils.
#pragma once

#include <array>
#include <vector>

#include "fem/soil.h"

namespace trackbed::fem {

/// Nine neighbours in the section (1 + dj + 3 (1 + dk)), displacement d of theirs to force c.
using Coefficients = std::array<std::array<std::array<double, 3>, 3>, 9>;

/// Of a node between two layers of elements: what multiplies u(i), u(i+1) + u(i-1) and u(i+1) - u(i-1) along
/// x. An extruded mesh is its own mirror image across every inner plane, so that even and odd parts do not
/// mix: forces and displacements both along x, or both not, take the first two, the others the last.
struct InnerStencil {
  Coefficients middle, even, odd;
};

/// Of a node in the first or last plane: what multiplies u there and in the next plane inwards.
struct EndStencil {
  Coefficients here, next;
};

/// Displacements (or forces) of all nodes with x running fastest: entry (3 section_node + axis) planes +
/// plane.
class SoilStencil {
 public:
  explicit SoilStencil(const Soil&);

  int planes() const { return planes_; }
  int section_size() const { return static_cast<int>(rows_.size()); }
  std::size_t size() const { return rows_.size() * 3 * static_cast<std::size_t>(planes_); }
  const double* row(const double* u, int section_node, int axis) const {
    return u + (static_cast<std::size_t>(section_node) * 3 + static_cast<std::size_t>(axis)) *
                   static_cast<std::size_t>(planes_);
  }
  double* row(double* u, int section_node, int axis) const {
    return const_cast<double*>(row(const_cast<const double*>(u), section_node, axis));
  }

  /// Elastic forces K u of the nodes of one section node, into three arrays of `planes` entries. Supports are
  /// not looked at.
  void force(const double* u, int section_node, const std::array<double*, 3>& out) const;
  /// K's diagonal at an inner plane.
  double diagonal(int section_node, int axis) const;

 private:
  struct Row {
    std::array<int, 9> neighbours;  // section nodes, -1 for none
    int type;
  };
  int planes_;
  std::vector<Row> rows_;
  std::vector<InnerStencil> inner_;  // of each type
  std::vector<EndStencil> start_, end_;
};

}  // namespace trackbed::fem
