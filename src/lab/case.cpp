#include "lab/case.h"

#include <algorithm>
#include <cmath>
#include <iterator>

#include <fmt/format.h>

#include "base/error.h"
#include "dem/laws/table.h"
#include "geom/mass_properties.h"
#include "geom/mesh_io.h"
#include "geom/solid.h"
#include "geom/stone.h"
#include "geom/stone_generator.h"
#include "geom/wear.h"
#include "lab/checks.h"

namespace trackbed {
namespace {

int material_index(const Document& document, const Simulation& sim, const std::string& where,
                   const std::string& name) {
  const int index = sim.find_material(name);
  if (index >= 0) return index;
  std::vector<std::string> known;
  for (const Material& m : sim.model.materials) known.push_back(m.name);
  refuse_unknown(document, where, "material", name, known);
}

/// A mesh that cannot be used, at the key that names it.
template <class Use>
auto use_mesh(const Document& document, const std::string& key, Use&& use) {
  try {
    return use();
  } catch (const InputError& error) {
    document.fail(key, error.what(), "repair the mesh or choose another");
  }
}

void build_materials(const CaseInput& in, Simulation& sim) {
  for (const auto& [name, m] : in.materials)
    sim.model.materials.push_back({name, m.kn, m.ks, m.friction, m.rolling_friction, m.density});
  LawKind law = LawKind::linear;
  for (const auto& [name, kind] : law_names)
    if (name == in.contact.law) law = kind;
  Dashpot dashpot{in.contact.dashpot.normal, in.contact.dashpot.shear, DashpotMode::full};
  const std::vector<std::pair<std::string, DashpotMode>> modes{
      {"full", DashpotMode::full},
      {"no_tension", DashpotMode::no_tension},
      {"full_slip_cut", DashpotMode::full_slip_cut},
      {"no_tension_slip_cut", DashpotMode::no_tension_slip_cut}};
  for (const auto& [name, mode] : modes)
    if (name == in.contact.dashpot.mode) dashpot.mode = mode;
  sim.model.pairs = PairTable(sim.model.materials, law, dashpot,
                              in.contact.inherit == "series" ? Inheritance::series : Inheritance::contact);
}

/// One template from a file; nothing when the stone is longer than the case allows.
std::optional<ClumpTemplate> stone_from_file(const std::filesystem::path& file, const ShapesInput& in,
                                             const ClumpFilling& filling) {
  // Scans come in all units; the grading gives the size. Here the stone is made about as large as ballast.
  TriangleMesh mesh = make_solid(read_mesh(file), file.string()).mesh;
  const double scale = 0.04 / std::cbrt(std::abs(mass_properties(mesh).volume));
  for (Vec3& v : mesh.vertices) v *= scale;
  const Stone stone = make_stone(worn(mesh, in.wear), file.filename().string(), filling);
  if (stone.shape.length > in.largest_elongation * stone.shape.thickness) return std::nullopt;
  return stone.clump;
}

/// The templates of one set; `key`: where it stands in the case.
std::vector<ClumpTemplate> make_templates(const Document& document, const std::string& key,
                                          const ShapesInput& stones, std::uint64_t seed, const Space& space) {
  if (space.is_plane()) {
    if (stones.fidelity != "ball")
      document.fail(key + ".fidelity", "stones of a model with a thickness are discs",
                    "choose fidelity = \"ball\", or leave out thickness");
    return {make_disc_template(0.02, space.thickness)};
  }
  if (stones.fidelity == "ball") return {make_ball_template(0.02)};
  ClumpFilling filling;
  filling.distance = stones.distance;
  filling.ratio = stones.ratio;
  filling.max_pebbles = stones.max_pebbles;
  filling.enlarge = stones.enlarge;
  const int n = stones.files.empty() ? stones.shapes : static_cast<int>(stones.files.size());
  std::vector<std::optional<ClumpTemplate>> made(static_cast<std::size_t>(n));
  std::vector<std::string> errors(static_cast<std::size_t>(n));
  const auto make_one = [&](std::size_t k) {
    try {
      if (stones.files.empty()) {
        StoneRecipe recipe;
        recipe.sieve_size = 0.04;
        made[k] = make_stone(worn(generate_stone(recipe, seed, static_cast<int>(k)), stones.wear),
                             fmt::format("stone-{}", k), filling)
                      .clump;
      } else {
        made[k] = stone_from_file(stones.files[k], stones, filling);
      }
    } catch (const InputError& error) {
      errors[k] = error.what();
    }
  };
#pragma omp parallel for schedule(dynamic)
  for (int k = 0; k < n; ++k) make_one(static_cast<std::size_t>(k));
  for (const std::string& error : errors)
    if (!error.empty()) document.fail(key + ".files", error, "repair the mesh or leave it out");
  std::vector<ClumpTemplate> templates;
  for (std::optional<ClumpTemplate>& t : made)
    if (t) templates.push_back(std::move(*t));
  if (templates.empty())
    document.fail(key + ".files", "no stone is left: all are longer than largest_elongation allows",
                  fmt::format("raise {}.largest_elongation", key));
  return templates;
}

void build_set(const Document& document, const std::string& name, const ShapesInput& in, Simulation& sim) {
  const std::string key = name.empty() ? "stones" : "stones.sets." + name;
  const int material = material_index(document, sim, key + ".material", in.material);
  if (sim.model.materials[static_cast<std::size_t>(material)].density == 0)
    document.fail("materials." + in.material, "the stones' material has no density",
                  "give density, for example \"2630 kg/m^3\"");
  std::vector<ClumpTemplate> templates;
  if (in.fidelity == "stand_in" && !sim.model.space.is_plane()) {
    const StoneSet& stones = sim.stone_set("");
    for (int t = stones.first; t < stones.first + stones.count; ++t)
      templates.push_back(make_stand_in(sim.model.templates[static_cast<std::size_t>(t)]));
  } else {
    templates = make_templates(document, key, in, in.seed.value_or(sim.seed), sim.model.space);
  }
  sim.stone_sets.push_back(
      {name, static_cast<int>(sim.model.templates.size()), static_cast<int>(templates.size()), material});
  std::ranges::move(templates, std::back_inserter(sim.model.templates));
}

void build_region(const Document& document, const std::string& name, const RegionInput& in, Simulation& sim) {
  try {
    sim.regions[name] = in.make();
  } catch (const InputError& error) {
    document.fail(in.here + ".file", error.what(), "mend the file or choose another");
  }
}

void build_body(const std::string& name, const BodyInput& in, int material, Simulation& sim,
                const Document& document) {
  TriangleMesh mesh = use_mesh(document, in.here + ".file", [&] { return in.shape(); });
  const MassProperties mass = mass_properties(mesh);
  const double density = sim.model.materials[static_cast<std::size_t>(material)].density;
  if (!in.mass && density == 0)
    document.fail(in.here + ".material", "a body of a material without density has no mass",
                  "give the body a mass, or its material a density");
  BodyProperties body;
  body.mass = in.mass ? *in.mass : density * mass.volume;
  body.inertia = body.mass / mass.volume * mass.principal;
  const auto has = [&](const std::string& what) {
    return std::find(in.free.begin(), in.free.end(), what) != in.free.end();
  };
  body.free_shift = {has("x"), has("y"), has("z")};
  body.free_turn = {has("turn_x"), has("turn_y"), has("turn_z")};
  if (sim.model.space.is_plane()) body.free_shift[1] = body.free_turn[0] = body.free_turn[2] = false;

  // The frame of a body is that of its principal axes; it stands as it was drawn.
  const WallShape shape = make_mesh_wall(name, in_principal_frame(mesh, mass));
  const int wall = add_wall(sim, {shape, material, body}, {mass.centre, Quat(mass.frame)});
  sim.state.walls[static_cast<std::size_t>(wall)].present = false;
}

}  // namespace

Simulation make_simulation(const Document& document, const CaseInput& in) {
  Simulation sim;
  sim.seed = in.seed;
  sim.model.space.thickness = in.thickness.value_or(0);
  build_materials(in, sim);
  check_names(document, in);
  for (const auto& [name, wall] : in.walls) {
    const int material = material_index(document, sim, wall.input->here + ".material", wall.input->material);
    use_mesh(document, wall.input->here + ".file",
             [&, &wall = wall, &name = name] { wall.input->build(name, material, sim); });
  }
  for (const auto& [name, body] : in.bodies)
    build_body(name, *body.input,
               material_index(document, sim, body.input->here + ".material", body.input->material), sim,
               document);
  build_set(document, "", in.stones, sim);
  for (const auto& [name, set] : in.stones.sets) build_set(document, name, set, sim);
  sim.force_limits = in.record.force_bins;
  for (const auto& [name, region] : in.regions) build_region(document, name, *region.input, sim);

  Model& m = sim.model;
  m.gravity = in.numerics.gravity;
  m.local_damping = in.numerics.damping;
  m.time_step.safety = in.numerics.safety;
  m.time_step.largest_travel = in.numerics.largest_travel;
  m.time_step.fixed = in.numerics.time_step;
  m.search.skin = in.numerics.skin.value_or(0);
  m.search.margin = in.numerics.margin.value_or(0);
  m.limits.overlap = in.numerics.overlap_limit;
  m.limits.speed = in.numerics.speed_limit;
  if (!sim.container.isEmpty()) m.domain = sim.container;
  check_plane(document, in, sim);
  check_time_step(document, in, sim);
  check_stages(document, in, sim);
  sim.changed();
  return sim;
}

}  // namespace trackbed
