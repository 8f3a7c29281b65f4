#include "lab/kept_bed.h"

#include "base/archive.h"
#include "base/error.h"
#include "lab/checkpoint.h"

namespace trackbed {
namespace {

/// What a template is made of.
struct Shape {
  std::string name;
  double volume = 0;
  Vec3 inertia = Vec3::Zero();
  std::vector<Vec3> centres;
  std::vector<double> radii;

  template <class A>
  void archive(A& a) {
    a(name, volume, inertia, centres, radii);
  }
};

Shape shape_of(const ClumpTemplate& t) {
  Shape shape{t.name, t.volume, t.inertia, {}, {}};
  for (const Pebble& pebble : t.pebbles) {
    shape.centres.push_back(pebble.centre);
    shape.radii.push_back(pebble.radius);
  }
  return shape;
}

ClumpTemplate template_of(Shape shape) {
  std::vector<Pebble> pebbles;
  for (std::size_t k = 0; k < shape.radii.size(); ++k) pebbles.push_back({shape.centres[k], shape.radii[k]});
  return make_clump_template(std::move(shape.name), std::move(pebbles), shape.volume, shape.inertia);
}

}  // namespace

void write_kept_bed(Simulation& sim, const std::filesystem::path& file) {
  std::vector<Shape> shapes;
  for (const ClumpTemplate& t : sim.model.templates) shapes.push_back(shape_of(t));
  Archive a;
  a(shapes, sim.state, sim.wall_reference);
  write_checked(file, a.bytes());
}

void read_kept_bed(const std::filesystem::path& file, Simulation& sim) {
  const auto fail = [&] {
    throw InputError(file.string() +
                     ": this is no bed that was kept by this program, or a part of one; delete it and it is "
                     "made anew");
  };
  auto bytes = read_checked(file);
  if (!bytes) fail();
  Archive a(std::move(*bytes));
  std::vector<Shape> shapes;
  const std::size_t walls = sim.state.walls.size();
  a(shapes, sim.state, sim.wall_reference);
  if (sim.state.walls.size() != walls) fail();
  sim.model.templates.clear();
  for (Shape& shape : shapes) sim.model.templates.push_back(template_of(std::move(shape)));
}

}  // namespace trackbed
