// The keys of a case.
#include <algorithm>
#include <functional>

#include "dem/laws/table.h"
#include "lab/case.h"

namespace trackbed {
namespace {

/// Whether each value is above the one before.
bool ascends(const std::vector<double>& values) {
  return std::ranges::adjacent_find(values, std::greater_equal<>()) == values.end();
}

}  // namespace

void declare(Fields& f, GradingInput& in) {
  f.quantities("sieves", in.sieves, Dimension::length, {.above = 0}, "sieve openings, ascending");
  f.quantities("passing", in.passing, Dimension::none, {.at_least = 0, .at_most = 1},
               "share of the mass that passes each sieve, from 0 to 100 %");
  f.choice(
      "size", in.size, {"volume", "sieve"},
      "what the sieve measures: volume, the diameter of the ball of equal volume; sieve, the smallest square "
      "hole that the stone passes");
  f.number("scale", in.scale, {.above = 0},
           "on all sieves: larger stones in their place, and fewer of them, for a bed that is run sooner");
  f.check(in.sieves.size() == in.passing.size() && in.sieves.size() >= 2, "passing",
          "there must be one share for each sieve, two at least", "give lists of equal length");
  f.check(ascends(in.sieves), "sieves", "the sieves do not ascend",
          "list the smallest opening first, each once");
  f.check(std::is_sorted(in.passing.begin(), in.passing.end()), "passing", "the shares fall",
          "a larger sieve lets at least as much pass");
  f.check(!in.passing.empty() && in.passing.front() == 0 && in.passing.back() == 1, "passing",
          "the grading does not sum to the whole", "let the shares begin with 0 % and end with 100 %");
}

void declare(Fields& f, ShapesInput& in) {
  f.paths("files", in.files,
          "stone meshes (STL, OBJ, PLY); by default shapes are made by the stone generator");
  f.integer("shapes", in.shapes, {.at_least = 1, .at_most = 1000},
            "number of shapes that the generator makes");
  f.integer(
      "seed", in.seed, {},
      "of the shapes that the generator makes, so that beds of several seeds are of the same shapes; by "
      "default the seed of the case");
  f.choice("fidelity", in.fidelity, {"clump", "ball", "stand_in"},
           "clump: pebbles fill the shape; ball: one pebble of equal volume, for which the keys of shape do "
           "not count; stand_in, for further sets: one pebble of the volume that the pebbles of a stone of "
           "[stones] have, which is to take its place");
  f.quantity("distance", in.distance, Dimension::angle, {.at_least = 0, .below = 3.14159265358979},
             "Distance: largest angle between two pebbles; larger is smoother, with more pebbles");
  f.number("ratio", in.ratio, {.above = 0, .at_most = 1},
           "Ratio: smallest pebble radius over the largest; larger is coarser, with fewer pebbles");
  f.integer("max_pebbles", in.max_pebbles, {.at_least = 0}, "most pebbles of a stone; 0 for no limit");
  f.flag("enlarge", in.enlarge,
         "enlarge the pebbles of a stone together until their union has the volume of its mesh; by default "
         "they stay inside, where few pebbles fill little of it");
  f.number("wear", in.wear, {.at_least = 0, .at_most = 0.5},
           "edges and corners are rounded over this share of the stone's mean radius, as by wear; the volume "
           "stays");
  f.number("largest_elongation", in.largest_elongation, {.above = 1},
           "stones from files whose length is more than this times their thickness are left out");
  f.text("material", in.material, "a material of the case");
}

void declare(Fields& f, StonesInput& in) {
  declare(f, static_cast<ShapesInput&>(in));
  f.check(in.fidelity != "stand_in", "fidelity", "there are no other stones to stand in for",
          "use clump or ball, and stand_in in a set of stones.sets");
  f.section("grading", in.grading, "stone sizes");
  f.table("sets", in.sets, "further sets of shapes by name, for the stages that name one");
}

void declare(Fields& f, MaterialInput& in) {
  f.quantity(required("kn"), in.kn, Dimension::stiffness, {.above = 0}, "normal stiffness of the piece");
  f.quantity(required("ks"), in.ks, Dimension::stiffness, {.at_least = 0}, "shear stiffness of the piece");
  f.number("friction", in.friction, {.at_least = 0, .at_most = 10},
           "Coulomb coefficient; a pair has the smaller one");
  f.number("rolling_friction", in.rolling_friction, {.at_least = 0},
           "rolling coefficient, used by the law linear_rolling; a pair has the smaller one");
  f.quantity("density", in.density, Dimension::density, {.at_least = 0}, "of stones and bodies made of it");
}

void declare(Fields& f, DashpotInput& in) {
  f.number("normal", in.normal, {.at_least = 0}, "share of critical damping");
  f.number("shear", in.shear, {.at_least = 0}, "share of critical damping");
  f.choice("mode", in.mode, {"full", "no_tension", "full_slip_cut", "no_tension_slip_cut"},
           "no_tension: the dashpot never pulls; slip_cut: no shear dashpot while slipping");
}

void declare(Fields& f, ContactInput& in) {
  std::vector<std::string> laws;
  for (const auto& [name, kind] : law_names) laws.emplace_back(name);
  f.choice("law", in.law, laws, "contact law");
  f.choice("inherit", in.inherit, {"series", "contact"},
           "series: stiffnesses belong to the pieces, two in touch are springs in series; contact: they are "
           "those of "
           "the contact, the softer of two");
  f.section("dashpot", in.dashpot, "viscous damping in contacts");
}

void declare(Fields& f, NumericsInput& in) {
  f.vector("gravity", in.gravity, Dimension::acceleration, {}, "gravity");
  f.number("damping", in.damping, {.at_least = 0, .below = 1},
           "local damping of stones and bodies (Cundall)");
  f.number("safety", in.safety, {.above = 0, .at_most = 1}, "of the stable time step");
  f.number("largest_travel", in.largest_travel, {.above = 0, .at_most = 0.5},
           "no point moves further in a step than this share of the smallest pebble's radius");
  f.quantity("time_step", in.time_step, Dimension::time, {.above = 0},
             "a step of your own; refused when it is above the stable one");
  f.quantity("skin", in.skin, Dimension::length, {.above = 0},
             "search distance of pebbles; changes speed, not results");
  f.quantity("margin", in.margin, Dimension::length, {.above = 0},
             "search distance of stones; changes speed, not results");
  f.number("overlap_limit", in.overlap_limit, {.above = 0},
           "the run stops when an overlap exceeds this share of the smaller stone's radius");
  f.quantity("speed_limit", in.speed_limit, Dimension::velocity, {.above = 0},
             "the run stops when a stone is faster");
}

void declare(Fields& f, RecordInput& in) {
  f.quantity("every", in.every, Dimension::time, {.above = 0},
             "simulated time between two rows of series.csv");
  f.texts("measures", in.measures, "further columns of series.csv");
  f.quantities(
      "force_bins", in.force_bins, Dimension::force, {.above = 0},
      "limits of the histogram of contact forces, and of the ranges of the measures contacts_FROM_TO_N");
  f.texts("stages", in.stages,
          "stages at whose ends tables, pictures and a ParaView frame are written; by default all");
  f.texts("keep", in.keep,
          "stages whose ends are kept in the folder of --keep: a run that is the same up to one of them "
          "begins there, "
          "with the same bits, and writes down what follows; not where regions come from files");
  f.flag("tables", in.tables, "write contacts.csv and stones.csv at the end of these stages");
  f.quantity("paraview_every", in.paraview_every, Dimension::time, {.above = 0},
             "simulated time between two ParaView frames; by default one at the end of each of these stages");
  f.choice("paraview_stones", in.paraview_stones, {"surfaces", "pebbles", "none"},
           "how stones appear in ParaView");
  f.flag("picture", in.picture,
         "draw the bed, its force chains and displacements at the end of these stages");
  f.quantity("displacement_scale", in.displacement_scale, Dimension::length, {.above = 0},
             "displacement within a stage that is drawn red; by default that of the stone that moved most");
  f.check(ascends(in.force_bins), "force_bins", "the limits do not ascend",
          "list the smallest first, each once");
}

void declare(Fields& f, CaseInput& in) {
  f.text(required("title"), in.title, "what the experiment is about");
  f.integer("seed", in.seed, {}, "of all random numbers");
  f.quantity(
      "thickness", in.thickness, Dimension::length, {.above = 0},
      "makes the model two-dimensional: discs of this thickness in the plane y = 0; forces are those of the "
      "thickness");
  f.section("stones", in.stones, "shapes, sizes and material of the stones");
  f.table("materials", in.materials, "materials by name");
  f.section("contact", in.contact, "contact law");
  f.table("walls", in.walls, wall_kinds(), "walls by name");
  f.table("bodies", in.bodies, body_kinds(), "bodies with mass, by name; a stage places them");
  f.table("regions", in.regions, region_kinds(), "parts of space by name, for the stages that name one");
  f.section("numerics", in.numerics, "gravity, damping, time step, search");
  f.section("record", in.record, "what is written");
  declare_stages(f, in.stages, "what happens, in this order");
  f.check(!in.stages.empty(), "stages", "there is no stage", "add [[stages]] with a kind");
  f.check(!in.materials.empty(), "materials", "there is no material", "add [materials.ballast]");
}

}  // namespace trackbed
