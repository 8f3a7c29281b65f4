#include "lab/track/track_case.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <set>
#include <stdexcept>

#include "base/error.h"
#include "fem/soil_parts.h"
#include "lab/track/support_curve.h"

namespace trackbed {
namespace {

constexpr std::array zone_keys{"lead_in", "approach", "bridge", "departure", "run_out"};
constexpr double clearance = 1.0;  // of a wheel from the rails' ends [m]

std::array<double, 5> lengths_of(const TrackLayoutInput& t) {
  return {t.lead_in, t.approach, t.bridge, t.departure, t.run_out};
}

fem::Support support_of(const std::string& word) {
  if (word == "free") return fem::Support::free;
  if (word == "roller") return fem::Support::roller;
  if (word == "fixed") return fem::Support::fixed;
  return fem::Support::absorbing;
}

fem::ConcreteModel model_of(const ConcreteInput& in) {
  const fem::HexKind kind = in.hexahedra == "full"    ? fem::HexKind::full
                            : in.hexahedra == "b_bar" ? fem::HexKind::b_bar
                                                      : fem::HexKind::incompatible;
  return {in.model == "solid", in.element, kind};
}

fem::Elastic solid(const SolidInput& in) {
  return {in.young, in.poisson, in.density};
}

/// Where the first sleeper of an embankment lies: half a spacing from its start, moved so that the nodes of
/// the ground lie evenly under it.
double first_sleeper(const TrackLayoutInput& t) {
  if (t.ground.model == "springs" || t.support) return t.spacing / 2;
  const double h = t.ground.element;
  const double width = std::max(1.0, std::round(t.sleeper.width / h)) * h;
  return std::round((t.spacing / 2 - width / 2) / h) * h + width / 2;
}

fem::SoilInput soil_input(const TrackCaseInput& in, TrackZone zone) {
  const GroundInput& g = in.track.ground;
  fem::SoilInput soil;
  soil.ballast = solid(g.ballast);
  soil.subgrade = solid(g.subgrade);
  soil.element_size = g.element;
  soil.length = zone == TrackZone::approach ? in.track.approach : in.track.departure;
  soil.ballast_depth = g.ballast.depth;
  soil.subgrade_depth = g.subgrade.depth;
  soil.half_width = g.half_width;
  soil.crest = g.crest;
  soil.shoulder_slope = g.slope;
  soil.whole_width = in.track.width == "whole";
  const bool has_bridge = in.track.bridge > 0;
  soil.start = support_of(zone == TrackZone::departure && has_bridge ? "free" : g.ends);
  soil.end = support_of(zone == TrackZone::approach && has_bridge ? "free" : g.ends);
  soil.side = support_of(g.side);
  soil.base = support_of(g.base);
  soil.mass_damping = g.mass_damping;
  soil.stiffness_damping = g.stiffness_damping;
  soil.sleepers = sleepers_of(in.track)[static_cast<std::size_t>(zone)];
  soil.first_sleeper = first_sleeper(in.track);
  soil.sleeper_spacing = in.track.spacing;
  soil.sleeper_width = std::max(1.0, std::round(in.track.sleeper.width / g.element)) * g.element;
  soil.sleeper_half_length = in.track.sleeper.length / 2;
  return soil;
}

/// Where grounds are kept, and who is told before one is worked out.
struct Grounds {
  const std::filesystem::path& keep;
  const std::function<void(TrackZone)>& reducing;
};

std::unique_ptr<fem::Part> make_ground(const TrackCaseInput& in, TrackZone zone, const Grounds& grounds) {
  const fem::Soil soil = fem::make_soil(soil_input(in, zone));
  const fem::ReductionInput reduction{in.track.ground.krylov, in.track.ground.krylov_beside_bridge,
                                      in.track.ground.window, in.track.ground.blow_frequency};
  const std::filesystem::path& keep = grounds.keep;
  if (grounds.reducing && (keep.empty() || !fem::is_kept(soil, reduction, keep))) grounds.reducing(zone);
  auto reduced = fem::make_reduced_part(
      soil, keep.empty() ? fem::reduce(soil, reduction) : fem::reduce(soil, reduction, keep),
      in.track.sleeper.patches);
  if (in.track.ground.model == "reduced") return reduced;
  return std::make_unique<fem::ExplicitPart>(soil, std::move(reduced), in.track.sleeper.patches);
}

void add_own_supports(const TrackLayoutInput& t, TrackZone kind, fem::Zone& zone) {
  const std::vector<int> n = sleepers_of(t);
  const int first = std::accumulate(n.begin(), n.begin() + static_cast<int>(kind), 0);
  for (const OwnSupportInput& in : t.supports) {
    const SupportCurve curve = read_support_curve(in.curve);
    for (const int number : numbers_of(in)) {
      const int place = support_of_sleeper(t, number) - first;
      if (place < 0 || place >= zone.sleepers) continue;
      zone.own_supports.emplace(place, half_of(curve));
      zone.gaps[static_cast<std::size_t>(place)] += curve.settlement + in.settlement;
    }
  }
}

/// What lies under the sleepers of a zone, and how they touch it.
fem::Zone make_zone(const TrackCaseInput& in, TrackZone kind, const Grounds& grounds) {
  const TrackLayoutInput& t = in.track;
  fem::Zone zone;
  zone.sleepers = sleepers_of(t)[static_cast<std::size_t>(kind)];
  if (kind == TrackZone::bridge) {
    zone.kind = fem::Zone::Kind::bridge;
    return zone;
  }
  if (zone.sleepers == 0) return zone;
  zone.gaps.assign(static_cast<std::size_t>(zone.sleepers), t.settlement);
  add_own_supports(t, kind, zone);
  zone.contact = fem::OneSidedSpring{t.sleeper.contact};
  const bool is_embankment = kind == TrackZone::approach || kind == TrackZone::departure;
  if (is_embankment && t.support) {
    fem::MeasuredSupport law{t.support->sinking, t.support->force, t.support->unloading / 2};
    for (double& force : law.force) force /= 2;  // of half a sleeper
    zone.contact = std::move(law);
  } else if (is_embankment && t.ground.model != "springs") {
    zone.ground = make_ground(in, kind, grounds);
  } else {
    const fem::TrackInput model = track_input(in);
    zone.ground = fem::make_springs({t.springs.stiffness, t.springs.damping, t.springs.mass}, zone.sleepers,
                                    model.sleeper, model.whole_width);
  }
  return zone;
}

/// Of steps too long for ground in full order.
void check_step(const Document& document, double step, const fem::Soil& soil) {
  const double longest = fem::stable_time_step(soil);
  if (step <= longest) return;
  document.fail(
      document.has("numerics") ? "numerics.time_step" : "track.ground.model",
      fmt::format("a time step of {:.4g} ms is too long for ground in full order", 1e3 * step),
      fmt::format("numerics.time_step = \"{:.4g} ms\" at most; less damping by stiffness allows more",
                  std::floor(1e6 * longest) / 1e3));
}

/// Of sleepers that series.csv is to show.
void check_recorded(const Document& document, const TrackCaseInput& in) {
  const std::vector<int> n = sleepers_of(in.track);
  const int before = n[0] + n[1], behind = n[3] + n[4];
  for (const double number : in.record.sleepers)
    if (number != std::round(number) || number == 0 || number < -before || number > behind)
      document.fail(
          "record.sleepers", fmt::format("there is no sleeper {:g}", number),
          fmt::format("sleepers are counted from the bridge: -{} to -1 before it, 1 to {} behind it", before,
                      behind));
}

/// Of rails that would be fastened beside a slab of solids.
void check_slab(const Document& document, const TrackLayoutInput& t) {
  const double needed = t.sleeper.rail_distance + t.sleeper.seat;
  if (t.bridge > 0 && t.slab.concrete.model == "solid" && t.slab.width < needed)
    document.fail("track.slab.width", "the rails' seats lie beyond the slab",
                  fmt::format("give {:g} m or more", needed));
}

double train_length(const TrackCaseInput& in) {
  return in.train.vehicle.bogie_distance + in.train.vehicle.wheelbase;
}

}  // namespace

std::vector<int> sleepers_of(const TrackLayoutInput& track) {
  std::vector<int> numbers;
  for (const double length : lengths_of(track))
    numbers.push_back(static_cast<int>(std::lround(length / track.spacing)));
  return numbers;
}

int sleeper_number(const TrackLayoutInput& track, int support) {
  const std::vector<int> n = sleepers_of(track);
  const int before = n[0] + n[1], behind = before + n[2];
  if (support < before) return support - before;
  return support < behind ? 0 : support - behind + 1;
}

int support_of_sleeper(const TrackLayoutInput& track, int number) {
  const std::vector<int> n = sleepers_of(track);
  if (number < 0 && -number <= n[1]) return n[0] + n[1] + number;
  if (number > 0 && number <= n[3]) return n[0] + n[1] + n[2] + number - 1;
  return -1;
}

std::vector<int> numbers_of(const SleeperRange& range) {
  std::vector<int> numbers;
  for (int n = range.from; n <= range.to; ++n)
    if (n != 0) numbers.push_back(n);
  return numbers;
}

double approach_start(const TrackLayoutInput& track) {
  return sleepers_of(track)[0] * track.spacing;
}

Journey journey_of(const TrackCaseInput& in) {
  const auto lengths = lengths_of(in.track);
  const double end = lengths[1] + lengths[2] + lengths[3] + lengths[4];
  return {in.train.start.value_or(train_length(in) + clearance - lengths[0]),
          in.train.end.value_or(end - clearance)};
}

void check_own_supports(const Document& document, const TrackLayoutInput& t) {
  std::set<int> known;
  for (std::size_t k = 0; k < t.supports.size(); ++k) {
    const std::string here = fmt::format("track.supports.{}", k);
    for (const int number : numbers_of(t.supports[k])) {
      if (support_of_sleeper(t, number) < 0)
        document.fail(here, fmt::format("there is no sleeper {} on an embankment", number),
                      "sleepers are counted from the bridge: -1, -2 before it, 1, 2 behind it");
      if (!known.insert(number).second)
        document.fail(here, fmt::format("sleeper {} has two supports of its own", number),
                      "let the ranges not overlap");
    }
    try {
      read_support_curve(t.supports[k].curve);
    } catch (const InputError& error) {
      document.fail(here + ".curve", error.what(), "give columns sinking [m] and force [N]");
    }
  }
}

void check_track(const Document& document, const TrackCaseInput& in) {
  const auto lengths = lengths_of(in.track);
  for (std::size_t z = 0; z < lengths.size(); ++z) {
    const double bays = lengths[z] / in.track.spacing;
    if (std::abs(bays - std::round(bays)) > 1e-6)
      document.fail(fmt::format("track.{}", zone_keys[z]),
                    "the length is no multiple of the sleepers' spacing",
                    fmt::format("give {} m or {} m", std::floor(bays) * in.track.spacing,
                                std::ceil(bays) * in.track.spacing));
  }
  const Journey journey = journey_of(in);
  // Rails begin and end half a spacing from the sleepers, which may be moved to the nodes of the ground.
  const double moved = first_sleeper(in.track) - in.track.spacing / 2;
  const double first = train_length(in) - lengths[0] + std::max(0.0, moved);
  const double last = lengths[1] + lengths[2] + lengths[3] + lengths[4] + std::min(0.0, moved);
  const std::string where = document.has("train") ? "train" : "track";
  if (journey.start + 1e-9 >= journey.end || first + 2 * clearance >= last)
    document.fail(
        where, "the train is longer than the track, or starts behind its end",
        fmt::format("from first to last wheel it has {} m; make the lead-in or the embankments longer",
                    train_length(in)));
  if (journey.start < first)
    document.fail("train.start", "the last wheel would stand before the track",
                  fmt::format("start at {:.6g} m or later", first));
  if (journey.end > last)
    document.fail("train.end", "the first wheel would leave the track",
                  fmt::format("end at {:.6g} m or earlier", last));
  check_own_supports(document, in.track);
  check_recorded(document, in);
  check_slab(document, in.track);
  const bool has_ground = in.track.ground.model != "springs" && !in.track.support;
  if (!has_ground) return;
  if (lengths[2] == 0 && lengths[1] > 0 && lengths[3] > 0)
    document.fail("track.bridge",
                  "without a bridge the ground would be cut in two where the embankments meet",
                  "make the approach as long as both and give departure = \"0 m\"");
  for (const TrackZone zone : {TrackZone::approach, TrackZone::departure}) {
    if (sleepers_of(in.track)[static_cast<std::size_t>(zone)] == 0) continue;
    std::optional<fem::Soil> soil;
    try {
      soil = fem::make_soil(soil_input(in, zone));
    } catch (const InputError& error) {
      document.fail(document.has("track") ? "track" : "title", error.what(),
                    "lengths of ground are multiples of track.ground.element");
    }
    if (in.track.ground.model == "explicit") check_step(document, in.numerics.time_step, *soil);
  }
}

fem::TrackInput track_input(const TrackCaseInput& in) {
  const TrackLayoutInput& t = in.track;
  const VehicleInput& v = in.train.vehicle;
  fem::TrackInput model;
  model.spacing = t.spacing;
  model.first_sleeper = first_sleeper(t);
  const double shear_area = t.rail.model == "euler" ? 0 : t.rail.shear_coefficient * t.rail.area;
  model.rail = {t.rail.young, t.rail.second_moment, t.rail.area,   t.rail.density,
                shear_area,   t.rail.poisson,       t.rail.damping};
  model.elements_per_bay = t.rail.elements;
  model.clamped_rail_ends = t.rail.ends == "clamped";
  model.fastener = {t.fastening.compression, t.fastening.tension, t.fastening.damping};
  model.sleeper = {t.sleeper.length,        t.sleeper.width,
                   t.sleeper.height,        t.sleeper.young,
                   t.sleeper.poisson,       t.sleeper.density,
                   t.sleeper.rail_distance, t.sleeper.elements,
                   t.sleeper.patches,       model_of(t.sleeper.concrete),
                   t.sleeper.seat};
  model.slab = {t.slab.width,
                t.slab.depth,
                t.slab.young,
                t.slab.poisson,
                t.slab.density,
                t.slab.damping,
                model_of(t.slab.concrete)};
  const double car = 4 * v.axle_load - 2 * v.bogie_mass - 4 * v.wheelset_mass;
  model.vehicle = {car / 2,
                   car / 2 * v.car_gyration * v.car_gyration,
                   v.bogie_mass / 2,
                   v.bogie_mass / 2 * v.bogie_gyration * v.bogie_gyration,
                   v.wheelset_mass / 2,
                   v.bogie_distance,
                   v.wheelbase,
                   {v.primary_stiffness, v.primary_damping},
                   {v.secondary_stiffness, v.secondary_damping},
                   v.secondary_bending};
  model.wheel_constant = v.wheel_contact;
  model.gravity = in.numerics.gravity;
  model.whole_width = t.width == "whole";
  return model;
}

fem::TrackModel make_track(const TrackCaseInput& in, const std::filesystem::path& keep,
                           const std::function<void(TrackZone)>& reducing) {
  std::vector<fem::Zone> zones;
  for (const TrackZone zone :
       {TrackZone::lead_in, TrackZone::approach, TrackZone::bridge, TrackZone::departure, TrackZone::run_out})
    zones.push_back(make_zone(in, zone, {keep, reducing}));
  return {track_input(in), std::move(zones)};
}

}  // namespace trackbed
