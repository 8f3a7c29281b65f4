// The keys of a track case. Values without a source in the meaning are those of W. Jia's thesis (TU Delft
// 2023), table 6-1; what it leaves open has a default of ours, with its reason.
#include <algorithm>
#include <functional>

#include "lab/track/track_case.h"

namespace trackbed {
namespace {

constexpr Range positive{.above = 0}, not_negative{.at_least = 0};
constexpr Range poisson_range{.at_least = 0, .below = 0.5};

}  // namespace

void declare(Fields& f, RailInput& in) {
  f.choice("model", in.model, {"timoshenko", "euler"}, "whether rails shear");
  f.quantity("young", in.young, Dimension::stress, positive, "Young's modulus of steel");
  f.number("poisson", in.poisson, poisson_range, "of steel");
  f.quantity("density", in.density, Dimension::density, positive, "of steel");
  f.quantity("area", in.area, Dimension::area, positive, "of one rail's section; UIC54");
  f.quantity("second_moment", in.second_moment, Dimension::second_moment, positive,
             "of one rail's section about its horizontal axis; UIC54");
  f.number("shear_coefficient", in.shear_coefficient, {.above = 0, .at_most = 1},
           "share of the area that shears (Timoshenko); 0.4 is usual for rails");
  f.quantity("damping", in.damping, Dimension::time, not_negative, "C = damping K of the rails");
  f.integer("elements", in.elements, {.at_least = 2, .at_most = 64}, "between two sleepers, an even number");
  f.choice("ends", in.ends, {"free", "clamped"}, "what holds the rails' ends");
  f.check(in.elements % 2 == 0, "elements", "an odd number has no node between two sleepers",
          "give 2, 4 or 6");
}

void declare(Fields& f, FasteningInput& in) {
  f.quantity("compression", in.compression, Dimension::stiffness, positive,
             "vertical stiffness of one fastening under pressure (rail pad)");
  f.quantity("tension", in.tension, Dimension::stiffness, positive, "and where the clamps pull");
  f.quantity("damping", in.damping, Dimension::damping, not_negative, "vertical, both ways");
}

void declare(Fields& f, ConcreteInput& in) {
  f.choice("model", in.model, {"beam", "solid"},
           "beam: Timoshenko's; solid: hexahedra, seen through their static shapes and three Krylov shapes "
           "of each");
  f.choice("hexahedra", in.hexahedra, {"incompatible", "b_bar", "full"},
           "of model solid: with incompatible modes, exact in bending; by selective reduced integration, as "
           "published; "
           "or in full");
  f.quantity("element", in.element, Dimension::length, positive,
             "of model solid: edges of the hexahedra are no longer than that");
}

void declare(Fields& f, SleeperInput& in) {
  f.quantity("length", in.length, Dimension::length, positive, "across the track");
  f.quantity("width", in.width, Dimension::length, positive, "along the track");
  f.quantity("height", in.height, Dimension::length, positive, "");
  f.quantity("young", in.young, Dimension::stress, positive, "Young's modulus of concrete");
  f.number("poisson", in.poisson, poisson_range, "of concrete");
  f.quantity("density", in.density, Dimension::density, positive,
             "of concrete; not published; 2400 kg/m^3 gives the published 3 kN under an unloaded sleeper");
  f.quantity("rail_distance", in.rail_distance, Dimension::length, positive,
             "between the middles of the rails; standard gauge");
  f.quantity(
      "contact", in.contact, Dimension::stiffness, positive,
      "penalty stiffness of half a sleeper's base on ballast; not published; ten times stiffer than ground");
  f.integer("elements", in.elements, {.at_least = 2, .at_most = 256}, "of the half of a sleeper");
  f.integer("patches", in.patches, {.at_least = 1, .at_most = 64},
            "strips in which the half of a sleeper touches the ballast, each by itself");
  declare(f, in.concrete);
  f.quantity("seat", in.seat, Dimension::length, positive,
             "of model solid: part of a sleeper's length under a rail; the foot of UIC 54");
  f.check(in.rail_distance < in.length, "rail_distance", "the rails lie beyond the sleeper's ends",
          "give less than the sleeper's length");
}

void declare(Fields& f, SolidInput& in) {
  f.quantity("young", in.young, Dimension::stress, positive, "Young's modulus");
  f.number("poisson", in.poisson, poisson_range, "Poisson's ratio");
  f.quantity("density", in.density, Dimension::density, positive,
             "not published; usual for packed stones and sand");
  f.quantity("depth", in.depth, Dimension::length, positive,
             "of the layer; that of the subgrade is not published and moves a sleeper's share of a load by 3 "
             "% only");
}

void declare(Fields& f, GroundInput& in) {
  f.choice("model", in.model, {"reduced", "explicit", "springs"},
           "reduced: the ground's finite elements by few shapes, implicit; explicit: all of them, central "
           "differences, slower, to check the reduced ones; springs: each sleeper on springs of its own");
  f.section("ballast", in.ballast, "upper layer of the embankments");
  f.section("subgrade", in.subgrade, "lower layer");
  f.quantity("element", in.element, Dimension::length, positive,
             "edge of the cubic elements; lengths of ground are multiples of it");
  f.quantity("half_width", in.half_width, Dimension::length, positive,
             "from the middle of the track to the side of the ground; not published");
  f.quantity("crest", in.crest, Dimension::length, positive,
             "half width of the top of the ballast, half_width at most");
  f.number("slope", in.slope, not_negative, "of the ballast beside the crest: across for each step down");
  f.choice("side", in.side, {"free", "roller", "fixed", "absorbing"},
           "what holds the side of the ground; not published");
  f.choice("base", in.base, {"roller", "fixed", "absorbing"}, "and its base; not published");
  f.choice("ends", in.ends, {"free", "roller", "fixed", "absorbing"},
           "and the faces where an embankment goes on; beside the bridge it is free");
  f.quantity("mass_damping", in.mass_damping, Dimension::frequency, not_negative,
             "a of C = a M + b K; not published; 3 % of critical at 27 Hz");
  f.quantity("stiffness_damping", in.stiffness_damping, Dimension::time, not_negative,
             "b of C = a M + b K; not published");
  f.integer("krylov", in.krylov, {.at_least = 0, .at_most = 8},
            "shapes beside the static one for each pressure shape of a sleeper, for reduced ground; with 4 "
            "it follows blows of 10 ms within 1 % at 75 mm, with 3 within 2 %");
  f.integer(
      "krylov_beside_bridge", in.krylov_beside_bridge, {.at_least = 0, .at_most = 12},
      "the same for sleepers within half a window of the bridge, which hang and strike with blows of 2 ms");
  f.quantity("blow_frequency", in.blow_frequency, Dimension::frequency, not_negative,
             "of the blows that these follow: those beyond `krylov` are worked out about it, not about rest");
  f.quantity("window", in.window, Dimension::length, positive,
             "length of ground in which a sleeper's shapes are worked out, for reduced ground");
}

void declare(Fields& f, SpringsInput& in) {
  f.quantity("stiffness", in.stiffness, Dimension::stiffness, positive, "under half a sleeper");
  f.quantity("damping", in.damping, Dimension::damping, not_negative, "under half a sleeper");
  f.quantity("mass", in.mass, Dimension::mass, positive, "of ballast that moves with half a sleeper");
}

void declare(Fields& f, MeasuredInput& in) {
  f.quantities(required("sinking"), in.sinking, Dimension::length, {},
               "of a whole sleeper at first loading, ascending");
  f.quantities(required("force"), in.force, Dimension::force, not_negative, "at each of these, from 0 N");
  f.quantity(required("unloading"), in.unloading, Dimension::stiffness, positive,
             "slope of unloading and loading again, as steep as the curve or steeper");
  f.check(in.sinking.size() == in.force.size() && in.sinking.size() >= 2, "force",
          "there must be one force for each sinking, two at least", "give lists of equal length");
  f.check(std::ranges::adjacent_find(in.sinking, std::greater_equal<>()) == in.sinking.end(), "sinking",
          "the list does not ascend", "list the smallest first, each once");
  f.check(std::ranges::is_sorted(in.force) && !in.force.empty() && in.force.front() == 0, "force",
          "the forces do not rise from 0 N", "let each be as large as the one before, the first 0 N");
  for (std::size_t k = 1; k < std::min(in.sinking.size(), in.force.size()); ++k)
    f.check(in.force[k] - in.force[k - 1] <= in.unloading * (in.sinking[k] - in.sinking[k - 1]) * (1 + 1e-9),
            "unloading", "the curve is steeper than this", "give the steepest slope of the curve or more");
}

void declare(Fields& f, SleeperRange& in) {
  f.integer(required("from"), in.from, {},
            "number of the first of these sleepers, counted from the bridge, negative before it");
  f.integer(required("to"), in.to, {}, "number of the last");
  f.check(in.from <= in.to, "to", "the last sleeper comes before the first",
          "give the smaller number as from");
}

void declare(Fields& f, OwnSupportInput& in) {
  declare(f, static_cast<SleeperRange&>(in));
  f.path(required("curve"), in.curve,
         "CSV with columns sinking and force of a whole sleeper, as they came one after the other; the last "
         "rise "
         "to the largest force counts, and what the sleeper has sunk for good before it is a settlement");
  f.quantity("settlement", in.settlement, Dimension::length, {},
             "further settlement under these sleepers, beside that of the curve and of all");
}

void declare(Fields& f, SlabInput& in) {
  f.quantity("width", in.width, Dimension::length, positive,
             "of the deck's section, a solid rectangle; not published");
  f.quantity("depth", in.depth, Dimension::length, positive, "of the section; not published; span / 15");
  f.quantity("young", in.young, Dimension::stress, positive, "Young's modulus");
  f.number("poisson", in.poisson, poisson_range, "Poisson's ratio");
  f.quantity("density", in.density, Dimension::density, positive, "not published; reinforced concrete");
  f.quantity("damping", in.damping, Dimension::time, not_negative, "C = damping K; not published");
  declare(f, in.concrete);
}

void declare(Fields& f, VehicleInput& in) {
  f.quantity("axle_load", in.axle_load, Dimension::mass, positive,
             "a quarter of the vehicle's mass; the car body has what bogies and wheelsets leave");
  f.quantity("bogie_distance", in.bogie_distance, Dimension::length, positive, "between the bogies' middles");
  f.quantity("wheelbase", in.wheelbase, Dimension::length, positive, "between the axles of a bogie");
  f.quantity("bogie_mass", in.bogie_mass, Dimension::mass, positive,
             "not published; the coach of the Manchester benchmark (Iwnicki 1998)");
  f.quantity("wheelset_mass", in.wheelset_mass, Dimension::mass, positive, "not published; likewise");
  f.quantity("car_gyration", in.car_gyration, Dimension::length, positive,
             "radius of gyration of the car body in pitch; not published; likewise");
  f.quantity("bogie_gyration", in.bogie_gyration, Dimension::length, positive,
             "of a bogie; not published; likewise");
  f.quantity("primary_stiffness", in.primary_stiffness, Dimension::stiffness, positive,
             "of the primary suspension; read as that of one wheel");
  f.quantity("primary_damping", in.primary_damping, Dimension::damping, not_negative,
             "of the primary suspension");
  f.quantity("secondary_stiffness", in.secondary_stiffness, Dimension::stiffness, positive,
             "of the secondary suspension; read as that of one side of a bogie");
  f.quantity("secondary_damping", in.secondary_damping, Dimension::damping, not_negative,
             "of the secondary suspension");
  f.quantity("secondary_bending", in.secondary_bending, Dimension::rotational_stiffness, not_negative,
             "of the secondary suspension in pitch, one side");
  f.quantity("wheel_contact", in.wheel_contact, Dimension::hertz_constant, positive,
             "C of force = C approach^1.5; not published; a conical wheel of radius 0.46 m (Zhai 2020)");
  f.check(in.bogie_distance > in.wheelbase, "bogie_distance", "the bogies overlap",
          "give more than the wheelbase");
  f.check(4 * in.axle_load > 2 * in.bogie_mass + 4 * in.wheelset_mass, "axle_load",
          "bogies and wheelsets are heavier than the whole vehicle",
          "give a larger axle load or smaller masses");
}

void declare(Fields& f, TrackLayoutInput& in) {
  f.quantity("lead_in", in.lead_in, Dimension::length, not_negative,
             "track before the approach, sleepers on springs of their own, where the train may start");
  f.quantity("approach", in.approach, Dimension::length, not_negative, "embankment before the bridge");
  f.quantity("bridge", in.bridge, Dimension::length, not_negative,
             "rails fastened to a simply supported slab; 0 m: none");
  f.quantity("departure", in.departure, Dimension::length, not_negative, "embankment behind the bridge");
  f.quantity("run_out", in.run_out, Dimension::length, not_negative, "track behind it, as the lead-in");
  f.quantity("spacing", in.spacing, Dimension::length, positive,
             "of sleepers; implied; lengths of zones are multiples of it");
  f.quantity("settlement", in.settlement, Dimension::length, {},
             "of everything beside the bridge, before the track lies down on it: 0 mm good, 4 mm moderate, 8 "
             "mm degraded");
  f.choice("width", in.width, {"half", "whole"}, "half: one rail, symmetric; whole: both, to check the half");
  f.section("rail", in.rail, "rails");
  f.section("fastening", in.fastening,
            "between rail and sleeper or bridge; longitudinal and lateral springs carry nothing in a "
            "symmetric track "
            "under vertical load and are not in the model");
  f.section("sleeper", in.sleeper, "sleepers: Timoshenko beams across the track");
  f.section("ground", in.ground, "embankments: ballast and subgrade");
  f.section("springs", in.springs,
            "under sleepers of lead-in and run-out, and of embankments of model springs");
  f.section("support", in.support,
            "a measured support of each sleeper of the embankments, in place of ground");
  f.sequence(
      "supports", in.supports,
      "sleepers of the embankments that lie on supports of their own in place of ground, such as a bed of "
      "stones");
  f.section("slab", in.slab, "bridge deck");
}

void declare(Fields& f, TrainInput& in) {
  f.quantity("speed", in.speed, Dimension::velocity, positive, "of the train");
  f.quantity("speed_up", in.speed_up, Dimension::time, positive,
             "the train stands at first, and reaches its speed within this time");
  f.quantity(
      "start", in.start, Dimension::length, {},
      "of the first wheel, behind the start of the approach; by default as far back as the track allows");
  f.quantity("end", in.end, Dimension::length, {},
             "of the first wheel; by default as far as the track allows");
  f.section("vehicle", in.vehicle, "one coach: car body, two bogies, four wheelsets");
}

void declare(Fields& f, TrackNumericsInput& in) {
  f.quantity("time_step", in.time_step, Dimension::time, positive, "of all parts");
  f.number(
      "alpha", in.alpha, {.at_least = -1.0 / 3, .at_most = 0},
      "of the method of Hilber, Hughes and Taylor: 0 keeps energy, less damps what is too fast for the step");
  f.quantity("gravity", in.gravity, Dimension::acceleration, positive, "downwards");
}

void declare(Fields& f, TrackRecordInput& in) {
  f.quantity("every", in.every, Dimension::time, positive, "simulated time between two rows of series.csv");
  f.quantities(
      "sleepers", in.sleepers, Dimension::none, {},
      "sleepers with columns in series.csv, counted from the bridge, negative before it; by default the ten "
      "nearest on both sides and one in the open track");
  f.quantity("paraview_every", in.paraview_every, Dimension::time, positive,
             "simulated time between two ParaView frames; by default none");
  f.number("paraview_scale", in.paraview_scale, positive, "by which displacements are drawn larger");
}

void declare(Fields& f, TrackCaseInput& in) {
  f.text(required("title"), in.title, "what the case is about");
  f.section(required("track"), in.track,
            "the track, from the start of the lead-in to the end of the run-out");
  f.section("train", in.train, "the train and its journey");
  f.section("numerics", in.numerics, "time step");
  f.section("record", in.record, "what is written");
}

}  // namespace trackbed
