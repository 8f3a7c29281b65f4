#include "geom/solid.h"

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Polygon_mesh_processing/border.h>
#include <CGAL/Polygon_mesh_processing/connected_components.h>
#include <CGAL/Polygon_mesh_processing/measure.h>
#include <CGAL/Polygon_mesh_processing/orient_polygon_soup.h>
#include <CGAL/Polygon_mesh_processing/orientation.h>
#include <CGAL/Polygon_mesh_processing/polygon_soup_to_polygon_mesh.h>
#include <CGAL/Polygon_mesh_processing/repair_degeneracies.h>
#include <CGAL/Polygon_mesh_processing/repair_polygon_soup.h>
#include <CGAL/Polygon_mesh_processing/self_intersections.h>
#include <CGAL/Polygon_mesh_processing/stitch_borders.h>
#include <CGAL/Polygon_mesh_processing/triangulate_hole.h>
#include <CGAL/Surface_mesh.h>
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <set>

#include "base/error.h"

namespace trackbed {
namespace {

namespace pmp = CGAL::Polygon_mesh_processing;
using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using Point = Kernel::Point_3;
using Surface = CGAL::Surface_mesh<Point>;
using Polygon = std::vector<std::size_t>;

constexpr double largest_hole = 0.01;           // of the surface
constexpr double largest_extra_shell = 0.02;    // of the volume
constexpr double largest_volume_change = 1e-3;  // by the cure of crossing facets
constexpr int untangling_rounds = 5;

std::string counted(std::size_t n, const std::string& one, const std::string& many) {
  return n == 1 ? "1 " + one : fmt::format("{} {}", n, many);
}

/// The mesh on its way to a solid. Each verb below does one repair and writes down what it changed.
class Repair {
 public:
  Repair(const TriangleMesh& mesh, std::string name);

  void clean_soup();
  void orient_soup();
  void build_surface();
  void drop_flat_facets();
  void fill_holes();
  void keep_largest_shell();
  void face_outward();
  void untangle();
  Solid result(const TriangleMesh& original);

 private:
  using Facets = std::vector<Surface::Face_index>;
  [[noreturn]] void refuse(const std::string& why) const { throw InputError(name_ + ": " + why); }
  void note(std::string repair) { repairs_.push_back(std::move(repair)); }
  double fill_all_holes();
  Facets crossing_facets() const;
  void cut_out(const Facets& facets, int rings);

  std::string name_;
  std::vector<Point> points_;
  std::vector<Polygon> polygons_;
  Surface surface_;
  bool most_turned_ = false;  // orient_soup turned the greater part of the facets
  std::vector<std::string> repairs_;
};

Repair::Repair(const TriangleMesh& mesh, std::string name) : name_(std::move(name)) {
  for (const Vec3& v : mesh.vertices) {
    if (!v.allFinite()) refuse("a vertex is not finite");
    points_.emplace_back(v.x(), v.y(), v.z());
  }
  for (const auto& f : mesh.facets) {
    for (int corner : f)
      if (corner < 0 || static_cast<std::size_t>(corner) >= mesh.vertices.size())
        refuse("a facet names a vertex that is not there");
    polygons_.push_back(
        {static_cast<std::size_t>(f[0]), static_cast<std::size_t>(f[1]), static_cast<std::size_t>(f[2])});
  }
}

void Repair::clean_soup() {
  const std::size_t loose = pmp::remove_isolated_points_in_polygon_soup(points_, polygons_);
  if (loose) note("dropped " + counted(loose, "unused vertex", "unused vertices"));
  const std::size_t merged = pmp::merge_duplicate_points_in_polygon_soup(points_, polygons_);
  if (merged) note("merged " + counted(merged, "doubled vertex", "doubled vertices"));
  const std::size_t flat =
      std::erase_if(polygons_, [](const Polygon& p) { return p[0] == p[1] || p[1] == p[2] || p[2] == p[0]; });
  if (flat) note("dropped " + counted(flat, "facet without area", "facets without area"));
  const std::size_t doubled = pmp::merge_duplicate_polygons_in_polygon_soup(points_, polygons_);
  if (doubled) note("dropped " + counted(doubled, "doubled facet", "doubled facets"));
  if (polygons_.size() < 4) refuse(fmt::format("{} facets are too few to enclose a body", polygons_.size()));
}

void Repair::orient_soup() {
  const std::vector<Polygon> before = polygons_;
  const std::vector<Point> places = points_;
  pmp::orient_polygon_soup(points_, polygons_);
  if (points_.size() > places.size())
    note(fmt::format("split non-manifold vertices and edges ({} added)",
                     counted(points_.size() - places.size(), "vertex", "vertices")));
  std::size_t turned = 0;
  for (std::size_t f = 0; f < before.size(); ++f) {
    // A turned facet lists its corners backwards; split vertices have new numbers but old places.
    const auto first = std::find_if(polygons_[f].begin(), polygons_[f].end(),
                                    [&](std::size_t k) { return points_[k] == places[before[f][0]]; });
    const std::size_t next = static_cast<std::size_t>(first - polygons_[f].begin() + 1) % 3;
    turned += points_[polygons_[f][next]] != places[before[f][1]];
  }
  // Which side is outward is settled by face_outward; a mixture is worth a word here.
  most_turned_ = turned > before.size() / 2;
  if (const std::size_t few = std::min(turned, before.size() - turned))
    note("turned " + counted(few, "facet", "facets") + " to agree with the neighbours");
}

void Repair::build_surface() {
  if (!pmp::is_polygon_soup_a_polygon_mesh(polygons_))
    refuse("the facets do not form a surface: more than two of them meet in an edge");
  pmp::polygon_soup_to_polygon_mesh(points_, polygons_, surface_);
  if (const std::size_t stitched = pmp::stitch_borders(surface_))
    note("joined " + counted(stitched, "pair of edges", "pairs of edges") + " that lay on each other");
}

void Repair::drop_flat_facets() {
  std::size_t flat = 0;
  for (const auto f : surface_.faces()) flat += pmp::is_degenerate_triangle_face(f, surface_);
  if (!flat) return;
  if (!pmp::remove_degenerate_faces(surface_)) refuse("facets without area could not be removed");
  note("removed " + counted(flat, "facet without area", "facets without area"));
}

/// Returns the area of the lids as a share of the whole surface.
double Repair::fill_all_holes() {
  std::vector<Surface::Halfedge_index> holes;
  pmp::extract_boundary_cycles(surface_, std::back_inserter(holes));
  Facets lids;
  for (const auto hole : holes) {
    const std::size_t had = lids.size();
    pmp::triangulate_hole(surface_, hole, std::back_inserter(lids));
    if (lids.size() == had) refuse("the mesh is open and one of its holes could not be closed");
  }
  return lids.empty() ? 0 : pmp::area(lids, surface_) / pmp::area(surface_);
}

void Repair::fill_holes() {
  std::vector<Surface::Halfedge_index> holes;
  pmp::extract_boundary_cycles(surface_, std::back_inserter(holes));
  if (holes.empty()) return;
  const double share = fill_all_holes();
  const std::string what =
      fmt::format("{} ({:.2g} % of the surface)", counted(holes.size(), "hole", "holes"), 100 * share);
  if (share > largest_hole) refuse("the mesh is open: " + what + "; up to 1 % would be closed");
  note("closed " + what);
}

void Repair::keep_largest_shell() {
  auto shell_of = surface_.add_property_map<Surface::Face_index, std::size_t>("f:shell", 0).first;
  const std::size_t count = pmp::connected_components(surface_, shell_of);
  if (count > 1) {
    std::vector<Facets> shells(count);
    for (const auto f : surface_.faces()) shells[shell_of[f]].push_back(f);
    std::vector<double> volumes;
    for (const Facets& shell : shells) {
      double volume = 0;
      const Point apex = surface_.point(surface_.target(surface_.halfedge(shell.front())));
      for (const auto f : shell) {
        const auto h = surface_.halfedge(f);
        volume += CGAL::volume(apex, surface_.point(surface_.source(h)), surface_.point(surface_.target(h)),
                               surface_.point(surface_.target(surface_.next(h))));
      }
      volumes.push_back(std::abs(volume));
    }
    const std::size_t largest =
        static_cast<std::size_t>(std::max_element(volumes.begin(), volumes.end()) - volumes.begin());
    double rest = 0;
    for (std::size_t k = 0; k < count; ++k) rest += k == largest ? 0 : volumes[k];
    const double share = volumes[largest] > 0 ? rest / volumes[largest] : 1;
    if (share > largest_extra_shell)
      refuse(fmt::format(
          "the mesh consists of {} separate bodies; all but the largest have {:.2g} % of its volume, "
          "up to 2 % would be dropped",
          count, 100 * share));
    pmp::keep_connected_components(surface_, std::vector<std::size_t>{largest}, shell_of);
    surface_.collect_garbage();
    note(fmt::format("dropped {} ({:.2g} % of the volume)",
                     counted(count - 1, "small extra shell", "small extra shells"), 100 * share));
  }
  surface_.remove_property_map(shell_of);
}

void Repair::face_outward() {
  const double volume = pmp::volume(surface_);
  if (std::abs(volume) < 1e-9 * std::pow(pmp::area(surface_), 1.5)) refuse("the mesh encloses no volume");
  if (volume < 0) pmp::reverse_face_orientations(surface_);
  if ((volume < 0) != most_turned_) note("turned the mesh outward: it was inside out");
}

Repair::Facets Repair::crossing_facets() const {
  std::vector<std::pair<Surface::Face_index, Surface::Face_index>> pairs;
  pmp::self_intersections(surface_, std::back_inserter(pairs));
  std::set<Surface::Face_index> facets;
  for (const auto& [a, b] : pairs) facets.insert({a, b});
  return {facets.begin(), facets.end()};
}

/// Removes the facets, `rings` rows of neighbours around them and whatever hangs on by a corner only.
void Repair::cut_out(const Facets& facets, int rings) {
  std::set<Surface::Face_index> cut(facets.begin(), facets.end());
  for (int ring = 0; ring < rings; ++ring) {
    std::set<Surface::Vertex_index> touched;
    for (const auto f : cut)
      for (const auto v : CGAL::vertices_around_face(surface_.halfedge(f), surface_)) touched.insert(v);
    for (const auto v : touched)
      for (const auto f : CGAL::faces_around_target(surface_.halfedge(v), surface_))
        if (f != Surface::null_face()) cut.insert(f);
  }
  std::vector<Polygon> kept;
  for (const auto f : surface_.faces()) {
    if (cut.contains(f)) continue;
    Polygon& corners = kept.emplace_back();
    for (const auto v : CGAL::vertices_around_face(surface_.halfedge(f), surface_)) corners.push_back(v);
  }
  std::vector<Point> points;
  for (const auto v : surface_.vertices()) points.push_back(surface_.point(v));
  pmp::remove_isolated_points_in_polygon_soup(points, kept);
  pmp::orient_polygon_soup(points, kept);  // splits the corners where two holes touch
  surface_.clear();
  pmp::polygon_soup_to_polygon_mesh(points, kept, surface_);
}

void Repair::untangle() {
  Facets crossing = crossing_facets();
  if (crossing.empty()) return;
  const std::size_t found = crossing.size();
  const std::string what = counted(found, "facet crosses", "facets cross") + " other facets of the mesh";
  if (found > surface_.number_of_faces() / 20) refuse(what + "; that is too many to be repaired");
  const double volume = pmp::volume(surface_);
  for (int round = 1; round <= untangling_rounds && !crossing.empty(); ++round) {
    cut_out(crossing, round);
    fill_all_holes();
    crossing = crossing_facets();
  }
  if (!crossing.empty() || !CGAL::is_closed(surface_)) refuse(what + " and could not be repaired");
  const double change = std::abs(pmp::volume(surface_) / volume - 1);
  if (change > largest_volume_change)
    refuse(fmt::format("{}; a repair would change the volume by {:.2g} %, up to 0.1 % is done", what,
                       100 * change));
  note(fmt::format("renewed the surface where {} (volume changed by {:.1g} %)", what, 100 * change));
}

Solid Repair::result(const TriangleMesh& original) {
  if (repairs_.empty()) return {original, {}};
  surface_.collect_garbage();
  Solid solid;
  solid.repairs = repairs_;
  for (const auto v : surface_.vertices()) {
    const Point& p = surface_.point(v);
    solid.mesh.vertices.emplace_back(p.x(), p.y(), p.z());
  }
  for (const auto f : surface_.faces()) {
    std::array<int, 3> facet{};
    std::size_t k = 0;
    for (const auto v : CGAL::vertices_around_face(surface_.halfedge(f), surface_))
      facet[k++] = static_cast<int>(static_cast<std::size_t>(v));
    solid.mesh.facets.push_back(facet);
  }
  return solid;
}

}  // namespace

Solid make_solid(const TriangleMesh& mesh, const std::string& name) {
  Repair repair(mesh, name);
  repair.clean_soup();
  repair.orient_soup();
  repair.build_surface();
  repair.drop_flat_facets();
  repair.fill_holes();
  repair.keep_largest_shell();
  repair.face_outward();
  repair.untangle();
  return repair.result(mesh);
}

}  // namespace trackbed
