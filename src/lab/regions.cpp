// The kinds of regions a case may name.
#include <algorithm>
#include <array>
#include <cmath>
#include <fstream>
#include <limits>
#include <memory>
#include <nanoflann.hpp>
#include <optional>
#include <sstream>
#include <vector>

#include <fmt/format.h>

#include "base/error.h"
#include "dem/overlap.h"
#include "geom/mesh_io.h"
#include "geom/solid.h"
#include "lab/case.h"

namespace trackbed {
namespace {

using Index = std::size_t;

struct BoxRegion : RegionInput {
  std::optional<Vec3> from, to;        // [m]
  std::optional<double> below, above;  // [m]

  /// What all of its bounds leave [m].
  Eigen::AlignedBox3d box() const {
    constexpr double end = std::numeric_limits<double>::infinity();
    Eigen::AlignedBox3d bounds(from.value_or(Vec3::Constant(-end)), to.value_or(Vec3::Constant(end)));
    bounds.min().z() = std::max(bounds.min().z(), above.value_or(-end));
    bounds.max().z() = std::min(bounds.max().z(), below.value_or(end));
    return bounds;
  }
  Region make() const override {
    return [bounds = box()](const Vec3& x) { return bounds.contains(x); };
  }
};

void declare(Fields& f, BoxRegion& in) {
  in.here = f.here();
  f.vector("from", in.from, Dimension::length, {}, "its lowest corner; by default without end");
  f.vector("to", in.to, Dimension::length, {}, "its highest corner; by default without end");
  f.quantity("above", in.above, Dimension::length, {}, "height above which it lies");
  f.quantity("below", in.below, Dimension::length, {}, "height below which it lies");
  f.check(in.from || in.to || in.above || in.below, "from", "the box has no bound",
          "give from and to, or above and below");
  f.check(!in.from || !in.to || (*in.to - *in.from).minCoeff() > 0, "to", "the box is empty",
          "each length of to is larger than that of from");
  f.check(in.box().sizes().z() > 0, in.below ? "below" : "above", "the box is empty",
          "let above be lower than below, and the layer between them reach between from and to");
}

struct MeshRegion : RegionInput {
  std::filesystem::path file;
  double unit = 1;  // [m]

  Region make() const override {
    const TriangleMesh mesh = read_mesh(file, unit);
    const auto shape = std::make_shared<const WallShape>(
        make_mesh_wall("region", make_solid(mesh, file.filename().string()).mesh));
    return [shape](const Vec3& x) { return is_inside(*shape, x); };
  }
};

void declare(Fields& f, MeshRegion& in) {
  in.here = f.here();
  f.path(required("file"), in.file, "closed mesh: STL, OBJ or PLY");
  f.quantity("unit", in.unit, Dimension::length, {.above = 0}, "length of 1 in the file");
}

/// Points with a value each.
struct Field {
  std::vector<Vec3> points;  // [m]
  std::vector<double> values;

  // What nanoflann asks for.
  Index kdtree_get_point_count() const { return points.size(); }
  double kdtree_get_pt(Index k, Index axis) const { return points[k][static_cast<Eigen::Index>(axis)]; }
  template <class Box>
  bool kdtree_get_bbox(Box&) const {
    return false;
  }
};

/// Columns x, y, z and a value, after a line of headers.
Field read_field(const std::filesystem::path& file) {
  std::ifstream in(file);
  if (!in) throw InputError(fmt::format("{}: cannot be read", file.string()));
  Field field;
  std::string line;
  std::getline(in, line);
  for (int number = 2; std::getline(in, line); ++number) {
    if (line.find_first_not_of(" \t\r") == std::string::npos) continue;
    std::ranges::replace(line, ',', ' ');
    std::istringstream numbers(line);
    std::array<double, 4> row{};
    for (double& value : row)
      if (!(numbers >> value) || !std::isfinite(value))
        throw InputError(fmt::format("{}:{}: a line is x,y,z,value", file.string(), number));
    field.points.emplace_back(row[0], row[1], row[2]);
    field.values.push_back(row[3]);
  }
  if (field.points.empty()) throw InputError(fmt::format("{}: has no points", file.string()));
  return field;
}

struct FieldRegion : RegionInput {
  std::filesystem::path file;
  double above = 0;

  Region make() const override {
    using Metric = nanoflann::L2_Simple_Adaptor<double, Field>;
    using Tree = nanoflann::KDTreeSingleIndexAdaptor<Metric, Field, 3>;
    const auto field = std::make_shared<const Field>(read_field(file));
    const auto tree = std::make_shared<const Tree>(3, *field);
    return [field, tree, limit = above](const Vec3& x) {
      unsigned nearest = 0;
      double distance2 = 0;
      tree->knnSearch(x.data(), 1, &nearest, &distance2);
      return field->values[nearest] > limit;
    };
  }
};

void declare(Fields& f, FieldRegion& in) {
  in.here = f.here();
  f.path(required("file"), in.file, "CSV of points: x, y, z [m] and a value, after a line of headers");
  f.number(required("above"), in.above, {},
           "the region is where the value of the nearest point is larger, in the unit of the file");
}

}  // namespace

const Kinds<RegionInput>& region_kinds() {
  static const Kinds<RegionInput> kinds{
      "region",
      {kind_of<RegionInput, BoxRegion>("box", "a box along the axes; a layer, if only heights bound it"),
       kind_of<RegionInput, MeshRegion>("mesh", "the inside of a closed mesh"),
       kind_of<RegionInput, FieldRegion>("field", "where a field given by points is above a limit")}};
  return kinds;
}

}  // namespace trackbed
