// The kinds of walls and bodies a case may name.
#include "lab/case.h"

#include <array>
#include <cmath>
#include <numbers>

#include "geom/mesh_io.h"
#include "geom/primitives.h"
#include "geom/solid.h"

namespace trackbed {
namespace {

struct PlaneInput : WallInput {
  Vec3 point = Vec3::Zero();
  Vec3 normal{0, 0, 1};

  void build(const std::string& name, int material_index, Simulation& sim) const override {
    const Quat up = Quat::FromTwoVectors(Vec3::UnitZ(), normal.normalized());
    add_wall(sim, {make_plane_wall(name, 0.5), material_index, {}}, {point, up});
  }
};

void declare(Fields& f, PlaneInput& in) {
  in.here = f.here();
  f.text(required("material"), in.material, "a material of the case");
  f.vector("point", in.point, Dimension::length, {}, "a point of the plane");
  f.vector("normal", in.normal, Dimension::none, {}, "towards the stones");
  f.check(in.normal.norm() > 0, "normal", "the normal is zero", "give a vector such as [0, 0, 1]");
}

/// Five unbounded planes: a floor at z = 0 and four sides, open above; in two dimensions three. Stones are
/// never lost over a rim.
struct BoxInput : WallInput {
  Vec3 size = Vec3::Zero();

  void build(const std::string& name, int material_index, Simulation& sim) const override {
    const double x = 0.5 * size.x(), y = 0.5 * size.y(), z = size.z();
    add_side(sim, name + ".floor", material_index, {Vec3::Zero(), Vec3::UnitZ()}, {x, y});
    add_side(sim, name + ".left", material_index, {Vec3(-x, 0, z / 2), Vec3::UnitX()}, {z / 2, y});
    add_side(sim, name + ".right", material_index, {Vec3(x, 0, z / 2), -Vec3::UnitX()}, {z / 2, y});
    if (!sim.model.space.is_plane()) add_ends(sim, name, material_index);
    sim.container.extend(Vec3(-x, -y, 0));
    sim.container.extend(Vec3(x, y, z));
  }
  bool is_container() const override { return true; }

 private:
  void add_ends(Simulation& sim, const std::string& name, int material_index) const {
    const double x = 0.5 * size.x(), y = 0.5 * size.y(), z = size.z();
    add_side(sim, name + ".front", material_index, {Vec3(0, -y, z / 2), Vec3::UnitY()}, {x, z / 2});
    add_side(sim, name + ".back", material_index, {Vec3(0, y, z / 2), -Vec3::UnitY()}, {x, z / 2});
  }
  struct Side {
    Vec3 middle, normal;
  };
  static void add_side(Simulation& sim, const std::string& name, int material, const Side& side,
                       const std::array<double, 2>& half) {
    const Quat up = Quat::FromTwoVectors(Vec3::UnitZ(), side.normal);
    WallShape shape = make_plane_wall(name, 1.0);
    for (Vec3& v : shape.mesh.vertices) v = Vec3(v.x() * half[0], v.y() * half[1], 0);
    const int wall = add_wall(sim, {std::move(shape), material, {}}, {side.middle, up});
    int axis = 0;
    side.normal.cwiseAbs().maxCoeff(&axis);
    sim.sides.push_back({wall, axis, side.normal[axis] < 0});
  }
};

void declare(Fields& f, BoxInput& in) {
  in.here = f.here();
  f.text(required("material"), in.material, "a material of the case");
  f.vector(required("size"), in.size, Dimension::length, {.above = 0},
           "inside; the floor is at z = 0, the middle at x = y = 0, the sides go on above the height");
}

/// Thin sides of triangles, as one wall that can be moved. In two dimensions it has no sides along y.
struct TrayInput : WallInput {
  Vec3 size = Vec3::Zero();
  Vec3 at = Vec3::Zero();
  bool floor = true;
  double rim = 0;  // [m]

  void build(const std::string& name, int material_index, Simulation& sim) const override {
    const double x = size.x(), y = size.y(), z = size.z();
    const Vec3 low(-x / 2, -y / 2, 0), along_x(x, 0, 0), along_y(0, y, 0), up(0, 0, z);
    TriangleMesh mesh;
    add_rectangle(mesh, low, along_y, up);
    add_rectangle(mesh, low + along_x, up, along_y);
    if (!sim.model.space.is_plane()) {
      add_rectangle(mesh, low, up, along_x);
      add_rectangle(mesh, low + along_y, along_x, up);
    }
    if (floor) add_rectangle(mesh, low, along_x, along_y);
    const double rim_height = floor ? z : 0;
    if (rim > 0) add_rim(mesh, low + Vec3(0, 0, rim_height), sim.model.space.is_plane());
    const int wall = add_wall(sim, {make_mesh_wall(name, mesh), material_index, {}}, {at, Quat::Identity()});
    sim.trays.push_back({wall, {low, low + size}, rim, rim_height});
    sim.container.extend(at + low);
    sim.container.extend(at + low + size);
  }
  bool is_container() const override { return true; }
  bool is_part_of_container() const override { return true; }

 private:
  /// Around the rectangle whose low corner this is.
  void add_rim(TriangleMesh& mesh, const Vec3& low, bool only_along_x) const {
    const Vec3 x(size.x(), 0, 0), y(0, size.y(), 0), out_x(rim, 0, 0), out_y(0, rim, 0);
    add_rectangle(mesh, low - out_x, out_x, y);
    add_rectangle(mesh, low + x, out_x, y);
    if (only_along_x) return;
    const Vec3 whole = x + 2 * out_x;
    add_rectangle(mesh, low - out_x - out_y, whole, out_y);
    add_rectangle(mesh, low - out_x + y, whole, out_y);
  }
};

void declare(Fields& f, TrayInput& in) {
  in.here = f.here();
  f.text(required("material"), in.material, "a material of the case");
  f.vector(required("size"), in.size, Dimension::length, {.above = 0}, "inside");
  f.vector("at", in.at, Dimension::length, {}, "where the middle of its base stands");
  f.flag("floor", in.floor, "whether it has one; without it is a frame, open below");
  f.quantity(
      "rim", in.rim, Dimension::length, {.at_least = 0},
      "width of a rim that leads outwards, along the upper edge, or the lower edge of a frame: no stone "
      "falls through where trays are shifted on each other");
}

struct MeshWallInput : WallInput {
  std::filesystem::path file;
  double unit = 1;
  Vec3 at = Vec3::Zero();
  bool container = false;

  void build(const std::string& name, int material_index, Simulation& sim) const override {
    TriangleMesh mesh = read_mesh(file, unit);
    if (container) mesh = make_solid(mesh, file.filename().string()).mesh;
    const int wall = add_wall(sim, {make_mesh_wall(name, mesh), material_index, {}}, {at, Quat::Identity()});
    if (!container) return;
    sim.container_mesh = wall;
    for (const Vec3& v : mesh.vertices) sim.container.extend(at + v);
  }
  bool is_container() const override { return container; }
};

void declare(Fields& f, MeshWallInput& in) {
  in.here = f.here();
  f.text(required("material"), in.material, "a material of the case");
  f.path(required("file"), in.file, "STL, OBJ or PLY; stones touch both sides of a facet");
  f.quantity("unit", in.unit, Dimension::length, {.above = 0}, "length of 1 in the file");
  f.vector("at", in.at, Dimension::length, {}, "where the file's origin stands");
  f.flag("container", in.container, "stones are filled into it; it must be closed");
}

void declare_body(Fields& f, BodyInput& in) {
  in.here = f.here();
  f.text(required("material"), in.material, "a material of the case");
  f.quantity("mass", in.mass, Dimension::mass, {.above = 0}, "by default volume x density of the material");
  f.choices("free", in.free, {"x", "y", "z", "turn_x", "turn_y", "turn_z"},
            "in which directions it may move, about which axes it may turn");
}

struct BlockInput : BodyInput {
  Vec3 size = Vec3::Zero();

  TriangleMesh shape() const override { return box_mesh(size, -0.5 * size); }
};

void declare(Fields& f, BlockInput& in) {
  declare_body(f, in);
  f.vector(required("size"), in.size, Dimension::length, {.above = 0}, "length, width and height");
}

struct WedgeInput : BodyInput {
  Vec3 size = Vec3::Zero();
  double angle = 0;  // [rad]
  int wedges = 1;

  TriangleMesh shape() const override { return wedge_mesh(size, angle, wedges); }
};

void declare(Fields& f, WedgeInput& in) {
  declare_body(f, in);
  f.vector(required("size"), in.size, Dimension::length, {.above = 0},
           "length, width and height of the block above the wedges");
  f.quantity(required("angle"), in.angle, Dimension::angle, {.above = 0, .below = 0.49 * std::numbers::pi},
             "between a face of a wedge and the horizontal");
  f.integer("wedges", in.wedges, {.at_least = 1, .at_most = 100},
            "side by side along the length, their ridges across it");
}

struct CylinderInput : BodyInput {
  double diameter = 0, height = 0;  // [m]

  TriangleMesh shape() const override { return cylinder_mesh(diameter, height); }
};

void declare(Fields& f, CylinderInput& in) {
  declare_body(f, in);
  f.quantity(required("diameter"), in.diameter, Dimension::length, {.above = 0},
             "of the circle around its prism of 64 sides");
  f.quantity(required("height"), in.height, Dimension::length, {.above = 0}, "along z");
}

struct MeshBodyInput : BodyInput {
  std::filesystem::path file;
  double unit = 1;

  TriangleMesh shape() const override {
    const TriangleMesh mesh = read_mesh(file, unit);
    return make_solid(mesh, file.filename().string()).mesh;
  }
};

void declare(Fields& f, MeshBodyInput& in) {
  declare_body(f, in);
  f.path(required("file"), in.file, "closed mesh: STL, OBJ or PLY");
  f.quantity("unit", in.unit, Dimension::length, {.above = 0}, "length of 1 in the file");
}

}  // namespace

const Kinds<WallInput>& wall_kinds() {
  static const Kinds<WallInput> kinds{
      "wall",
      {kind_of<WallInput, PlaneInput>("plane", "an unbounded plane"),
       kind_of<WallInput, BoxInput>("box", "a floor and four sides, open above: the container"),
       kind_of<WallInput, TrayInput>(
           "tray",
           "thin sides, with or without floor and rim, as one wall that can be moved; "
           "all trays together are the container"),
       kind_of<WallInput, MeshWallInput>("mesh", "triangles from a file")}};
  return kinds;
}

const Kinds<BodyInput>& body_kinds() {
  static const Kinds<BodyInput> kinds{
      "body",
      {kind_of<BodyInput, BlockInput>("block", "a cuboid, such as a sleeper"),
       kind_of<BodyInput, CylinderInput>("cylinder", "an upright cylinder, such as a loading plate"),
       kind_of<BodyInput, WedgeInput>("wedge", "a cuboid on wedges that point down"),
       kind_of<BodyInput, MeshBodyInput>("mesh", "a solid from a file")}};
  return kinds;
}

}  // namespace trackbed
