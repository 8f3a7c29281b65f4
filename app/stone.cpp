// trackbed stone: what a mesh is worth as a stone, before any simulation.
#include <fmt/format.h>

#include <chrono>
#include <cstdio>
#include <filesystem>
#include <numbers>
#include <string>
#include <vector>

#include "base/error.h"
#include "command_line.h"
#include "commands.h"
#include "geom/mesh_io.h"
#include "geom/solid.h"
#include "geom/stone.h"
#include "geom/stone_generator.h"
#include "geom/wear.h"
#include "io/picture.h"

namespace trackbed {
namespace {

struct Options {
  std::vector<std::filesystem::path> files;
  double distance = 150;  // [degrees]
  double ratio = 0.3;
  int max_pebbles = 0;
  std::string unit = "mm";
  std::filesystem::path out = ".";
  int generate = 0;
  std::uint64_t seed = 1;
  double wear = 0;
  bool convex = false, enlarge = false;

  ClumpFilling filling() const {
    ClumpFilling filling{distance * std::numbers::pi / 180, ratio, max_pebbles};
    filling.enlarge = enlarge;
    return filling;
  }
};

void declare(CLI::App& app, Options& o) {
  app.add_option("FILE", o.files, "stone meshes: .stl, .obj or .ply");
  app.add_option("--distance", o.distance,
                 "largest angle between pebbles in degrees, 0 to 180: more is smoother")
      ->capture_default_str();
  app.add_option("--ratio", o.ratio, "smallest pebble over largest, above 0 to 1: more is coarser")
      ->capture_default_str();
  app.add_option("--max-pebbles", o.max_pebbles, "stop there; 0 for no limit")->capture_default_str();
  app.add_flag("--enlarge", o.enlarge, "enlarge the pebbles together to the volume of the stone");
  app.add_option("--wear", o.wear, "round edges over this share of the mean radius, as by wear")
      ->check(CLI::Range(0.0, 0.5))
      ->capture_default_str();
  app.add_option("--unit", o.unit, "unit of the files")
      ->check(CLI::IsMember({"m", "cm", "mm"}))
      ->capture_default_str();
  app.add_option("--out", o.out, "folder for pictures and made stones")->capture_default_str();
  app.add_option("--generate", o.generate, "make N stones of 50 mm sieve size instead and write them as STL")
      ->check(CLI::Range(1, 100'000));
  app.add_option("--seed", o.seed, "of the made stones")->capture_default_str();
  app.add_flag("--convex", o.convex, "make them without hollows");
}

double metres(const std::string& unit) {
  return unit == "mm" ? 1e-3 : unit == "cm" ? 1e-2 : 1;
}

TriangleMesh read_scaled(const std::filesystem::path& path, const std::string& unit) {
  TriangleMesh mesh = read_mesh(path);
  for (Vec3& v : mesh.vertices) v *= metres(unit);
  return mesh;
}

/// The mesh on the left, the clump on the right, both from the same place.
void write_picture(const ClumpTemplate& clump, const std::filesystem::path& path) {
  const Colour mesh_colour{0.80f, 0.76f, 0.70f}, pebble_colour{0.55f, 0.68f, 0.85f};
  const Vec3 direction(0.5, 0.8, -0.45);
  Eigen::AlignedBox3d box;
  for (const Vec3& v : clump.surface.vertices) box.extend(v);
  Picture picture(1200, 600);
  picture.look(direction, box, {0, 0, 0.5, 1});
  picture.draw_mesh(clump.surface, {}, 1, mesh_colour);
  picture.look(direction, box, {0.5, 0, 0.5, 1});
  for (const Pebble& p : clump.pebbles) picture.draw_sphere(p.centre, p.radius, pebble_colour);
  picture.write_png(path);
}

void print_header() {
  fmt::print(
      "{:24} {:>7} {:>9} {:>7} {:>7} {:>7} {:>7} {:>7} {:>7} {:>8} {:>7} {:>7} {:>8} {:>8} {:>6}  {}\n",
      "stone", "facets", "V [cm3]", "L [mm]", "I [mm]", "S [mm]", "spher.", "convex.", "round.", "sieve",
      "pebbles", "V/Vmesh", "mean[mm]", "max [mm]", "t [s]", "repairs");
}

void print_line(const Stone& stone, const std::vector<std::string>& repairs, double seconds) {
  const Shape& s = stone.shape;
  fmt::print(
      "{:24} {:7} {:9.2f} {:7.1f} {:7.1f} {:7.1f} {:7.3f} {:7.3f} {:7.3f} {:8.1f} {:7} {:7.4f} {:8.3f} "
      "{:8.3f} "
      "{:6.2f}  {}\n",
      stone.clump.name, stone.clump.surface.facets.size(), stone.clump.volume * 1e6, s.length * 1e3,
      s.breadth * 1e3, s.thickness * 1e3, s.sphericity, s.convexity, s.roundness, s.sieve_size * 1e3,
      stone.clump.pebbles.size(), stone.error.volume_ratio, stone.error.mean_distance * 1e3,
      stone.error.max_distance * 1e3, seconds,
      repairs.empty() ? "none" : fmt::format("{}", fmt::join(repairs, "; ")));
}

void treat(const TriangleMesh& mesh, const std::string& name, const Options& options) {
  const auto begin = std::chrono::steady_clock::now();
  const Solid solid = make_solid(mesh, name);
  const Stone stone = make_stone(worn(solid.mesh, options.wear), name, options.filling());
  const std::chrono::duration<double> took = std::chrono::steady_clock::now() - begin;
  write_picture(stone.clump, options.out / (name + ".png"));
  print_line(stone, solid.repairs, took.count());
}

/// STL files have no unit; like most, these are in the unit asked for.
void make_stones(const Options& options) {
  StoneRecipe recipe = options.convex ? convex_recipe() : StoneRecipe{};
  recipe.sieve_size = 0.05;
  for (int k = 0; k < options.generate; ++k) {
    const std::string name = fmt::format("stone_{}_{:03}", options.seed, k);
    const TriangleMesh mesh = generate_stone(recipe, options.seed, k);
    TriangleMesh scaled = mesh;
    for (Vec3& v : scaled.vertices) v /= metres(options.unit);
    write_stl(scaled, options.out / (name + ".stl"));
    treat(mesh, name, options);
  }
}

}  // namespace

int stone_command(int argc, char** argv) {
  CLI::App app("Checks stone meshes, measures them, fills them with pebbles and draws both.",
               "trackbed stone");
  Options options;
  declare(app, options);
  if (const auto code = parse(app, argc, argv)) return *code;
  if (options.files.empty() == (options.generate == 0))
    throw InputError("give either stone files or --generate N");
  std::filesystem::create_directories(options.out);
  print_header();
  if (options.generate) make_stones(options);
  int refused = 0;
  for (const auto& file : options.files) {
    try {
      treat(read_scaled(file, options.unit), file.filename().string(), options);
    } catch (const InputError& error) {
      ++refused;
      fmt::print(stderr, "refused: {}\n", error.what());
    }
  }
  return refused ? 2 : 0;
}

}  // namespace trackbed
