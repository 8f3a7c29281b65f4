#include "fem/track_model.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <stdexcept>
#include <utility>

#include "fem/solid_block.h"

namespace trackbed::fem {
namespace {

std::size_t at(Index k) {
  return static_cast<std::size_t>(k);
}

Beam make_rail(const TrackInput& in, const std::vector<Zone>& zones) {
  if (in.elements_per_bay < 2 || in.elements_per_bay % 2 != 0)
    throw std::invalid_argument("a rail has an even number of elements between two sleepers");
  const int bays =
      std::accumulate(zones.begin(), zones.end(), 0, [](int sum, const Zone& z) { return sum + z.sleepers; });
  const double start = in.first_sleeper - in.spacing / 2;
  const BeamEnd end = in.clamped_rail_ends ? BeamEnd::clamped : BeamEnd::free;
  return {in.rail, even_nodes(start, start + bays * in.spacing, bays * in.elements_per_bay), end, end};
}

/// Mean deflection of a beam between a and b as weights of its coordinates.
VectorXd mean_deflection(const Beam& beam, double a, double b) {
  VectorXd mean = VectorXd::Zero(beam.ports());
  const auto& nodes = beam.nodes();
  const double inner = 0.5 / std::sqrt(3.0);  // two Gauss points are exact for cubic shapes
  for (std::size_t e = 0; e + 1 < nodes.size(); ++e) {
    const double low = std::max(a, nodes[e]), high = std::min(b, nodes[e + 1]);
    if (high <= low) continue;
    for (const double xi : {0.5 - inner, 0.5 + inner})
      for (const LinkEnd& end : beam.at(low + xi * (high - low), 0, 0.5 * (high - low) / (b - a)))
        mean(end.port) += end.weight;
  }
  return mean;
}

/// Where rails lie across the track.
std::vector<double> rail_places(const TrackInput& in) {
  const double half = in.sleeper.rail_distance / 2;
  return in.whole_width ? std::vector{-half, half} : std::vector{half};
}

/// A sleeper of hexahedra or its half; ports as those of the beam.
Structure<MatrixXd> solid_sleeper(const TrackInput& in) {
  const Sleeper& s = in.sleeper;
  const double half = s.length / 2, start = in.whole_width ? -half : 0;
  SolidBlock block{{-s.width / 2, start, 0},
                   {s.width / 2, half, s.height},
                   s.model.element,
                   {s.young, s.poisson, s.density},
                   s.model.kind,
                   !in.whole_width};
  std::vector<FacePatch> ports;
  const int patches = (in.whole_width ? 2 : 1) * s.patches;
  for (int p = 0; p < patches; ++p)
    ports.push_back(
        {-s.width / 2, s.width / 2, start + p * half / s.patches, start + (p + 1) * half / s.patches, false});
  for (const double y : rail_places(in))
    ports.push_back({-s.width / 2, s.width / 2, y - s.seat / 2, std::min(half, y + s.seat / 2), true});
  return reduce_block(block, ports, in.gravity, 0);
}

/// A slab of hexahedra or its half; ports: the seats of each rail, one fastening after the other.
Structure<MatrixXd> solid_slab(const TrackInput& in, int fastenings) {
  const Slab& s = in.slab;
  const double half = s.width / 2;
  SolidBlock block{{0, in.whole_width ? -half : 0, 0},
                   {fastenings * in.spacing, half, s.depth},
                   s.model.element,
                   {s.young, s.poisson, s.density},
                   s.model.kind,
                   !in.whole_width,
                   true};
  std::vector<FacePatch> ports;
  const double along = in.sleeper.width / 2, across = in.sleeper.seat / 2;
  for (int k = 0; k < fastenings; ++k)
    for (const double y : rail_places(in)) {
      const double x = (k + 0.5) * in.spacing;
      ports.push_back({x - along, x + along, y - across, y + across, true});
    }
  return reduce_block(block, ports, 0, s.damping);
}

/// A sleeper or its half; ports: the patches from low y to high y, then the rail seats.
Structure<MatrixXd> sleeper_structure(const TrackInput& in) {
  const Sleeper& s = in.sleeper;
  if (s.model.solid) return solid_sleeper(in);
  const double half = s.length / 2, area = s.width * s.height;
  const double shear = 10 * (1 + s.poisson) / (12 + 11 * s.poisson) * area;  // Cowper (1966), a rectangle
  const BeamSection section{s.young, s.width * std::pow(s.height, 3) / 12, area, s.density, shear, s.poisson,
                            0};
  const int sides = in.whole_width ? 2 : 1;
  const Beam beam(section, even_nodes(in.whole_width ? -half : 0, half, sides * s.elements),
                  in.whole_width ? BeamEnd::free : BeamEnd::guided, BeamEnd::free);
  const Structure<SparseMatrix> made = beam.structure(in.gravity);
  MatrixXd ports(beam.ports(), sides * (s.patches + 1));
  Index column = 0;
  const double start = beam.nodes().front();
  for (int p = 0; p < sides * s.patches; ++p)
    ports.col(column++) =
        mean_deflection(beam, start + p * half / s.patches, start + (p + 1) * half / s.patches);
  for (const double y : rail_places(in)) {
    ports.col(column).setZero();
    for (const LinkEnd& end : beam.at(y, 0, 1)) ports(end.port, column) = end.weight;
    ++column;
  }
  return {MatrixXd(made.mass), MatrixXd(made.damping), MatrixXd(made.stiffness), made.load,
          ports.sparseView()};
}

Beam slab_beam(const TrackInput& in, double start, int fastenings) {
  const Slab& s = in.slab;
  const double width = in.whole_width ? s.width : s.width / 2, area = width * s.depth;
  const double shear = 10 * (1 + s.poisson) / (12 + 11 * s.poisson) * area;
  return {{s.young, width * std::pow(s.depth, 3) / 12, area, s.density, shear, s.poisson, s.damping},
          even_nodes(start, start + fastenings * in.spacing, 2 * fastenings),
          BeamEnd::simple,
          BeamEnd::simple};
}

/// The share of a patch in the law of a half of a sleeper.
LinkLaw shared(const LinkLaw& law, int patches) {
  if (const auto* spring = std::get_if<OneSidedSpring>(&law))
    return OneSidedSpring{spring->stiffness / patches};
  if (auto support = law; auto* measured = std::get_if<MeasuredSupport>(&support)) {
    for (double& force : measured->force) force /= patches;
    measured->unloading /= patches;
    return support;
  }
  if (const auto* spring = std::get_if<ClampedSpring>(&law))
    return ClampedSpring{spring->compression / patches, spring->tension / patches, spring->damping / patches};
  throw std::invalid_argument("sleepers lie on springs or on a measured support");
}

Vehicle of_sides(Vehicle v, int sides) {
  for (double* value : {&v.car_mass, &v.car_pitch_inertia, &v.bogie_mass, &v.bogie_pitch_inertia,
                        &v.wheelset_mass, &v.primary.stiffness, &v.primary.damping, &v.secondary.stiffness,
                        &v.secondary.damping, &v.secondary_bending})
    *value *= sides;
  return v;
}

}  // namespace

std::unique_ptr<Part> make_springs(const Springs& springs, int sleepers, const Sleeper& sleeper,
                                   bool whole_width) {
  const Index n = (whole_width ? 2 : 1) * sleeper.patches;
  const MatrixXd one = MatrixXd::Identity(n, n) / sleeper.patches;
  return std::make_unique<DensePart>(
      Structure<MatrixXd>{springs.mass * one, springs.damping * one, springs.stiffness * one,
                          VectorXd::Zero(n), MatrixXd::Identity(n, n), true},
      sleepers);
}

TrackModel::TrackModel(const TrackInput& input, std::vector<Zone> zones)
    : input_(input), rail_(make_rail(input, zones)), next_x_(input.first_sleeper) {
  first_rail_ = system_.add(std::make_unique<SparsePart>(rail_.structure(input_.gravity), sides()));
  for (std::size_t z = 0; z < zones.size(); ++z) {
    if (zones[z].kind == Zone::Kind::ground)
      add_ground(zones[z], static_cast<int>(z));
    else
      add_bridge(zones[z], static_cast<int>(z));
  }
  add_train();
}

void TrackModel::add_ground(Zone& zone, int number) {
  const Index patches = sides() * input_.sleeper.patches, ports = patches + sides();
  if (zone.sleepers < 1) return;
  const Index sleepers = system_.add(std::make_unique<DensePart>(sleeper_structure(input_), zone.sleepers));
  Index ground = -1;
  if (zone.ground) {
    if (zone.ground->ports() != patches * zone.sleepers)
      throw std::invalid_argument("the ground of a zone has other ports than its sleepers");
    ground = system_.add(std::move(zone.ground));
  }
  const LinkLaw on_ground = shared(zone.contact, input_.sleeper.patches);
  for (int s = 0; s < zone.sleepers; ++s, next_x_ += input_.spacing) {
    const Index sleeper = sleepers + s * ports;
    const int group = static_cast<int>(supports_.size());
    Support support{next_x_, number, system_.links(), -1, patches, sleeper + patches, 0};
    for (int side = 0; side < sides(); ++side) {
      std::vector<LinkEnd> ends = rail_.at(next_x_, rail_port(0, side), -1);
      support.rail_port = ends.front().port;
      ends.push_back({sleeper + patches + side, 1.0});
      system_.add(Link{input_.fastener, std::move(ends), 0, group});
    }
    support.first_contact = system_.links();
    const double gap = zone.gaps.empty() ? 0 : zone.gaps.at(at(s));
    const auto own = zone.own_supports.find(s);
    const bool has_own = own != zone.own_supports.end();
    const LinkLaw contact = has_own ? shared(own->second, input_.sleeper.patches) : on_ground;
    for (Index p = 0; p < patches; ++p) {
      std::vector<LinkEnd> ends{{sleeper + p, -1.0}};
      if (ground >= 0 && !has_own) ends.push_back({ground + s * patches + p, 1.0});
      system_.add(Link{contact, std::move(ends), gap, group});
    }
    supports_.push_back(support);
  }
}

/// The ports under the rails, those of one fastening after those of another; a beam has one for both rails.
std::vector<Index> TrackModel::add_slab(int fastenings) {
  std::vector<Index> seats;
  if (input_.slab.model.solid) {
    const Index first = system_.add(std::make_unique<DensePart>(solid_slab(input_, fastenings)));
    for (int k = 0; k < fastenings * sides(); ++k) seats.push_back(first + k);
    return seats;
  }
  const Beam beam = slab_beam(input_, next_x_ - input_.spacing / 2, fastenings);
  const Index first = system_.add(std::make_unique<SparsePart>(beam.structure(0)));
  for (int k = 0; k < fastenings; ++k)
    for (int side = 0; side < sides(); ++side)
      seats.push_back(first + beam.port(static_cast<std::size_t>(2 * k + 1)));
  return seats;
}

void TrackModel::add_bridge(const Zone& zone, int number) {
  if (zone.sleepers < 1) return;
  const std::vector<Index> seats = add_slab(zone.sleepers);
  for (int k = 0; k < zone.sleepers; ++k, next_x_ += input_.spacing) {
    Support support{next_x_, number, system_.links(), -1, 0, seats[at(k * sides())], 0};
    for (int side = 0; side < sides(); ++side) {
      std::vector<LinkEnd> ends = rail_.at(next_x_, rail_port(0, side), -1);
      support.rail_port = ends.front().port;
      ends.push_back({seats[at(k * sides() + side)], 1.0});
      system_.add(Link{input_.fastener, std::move(ends), 0});
    }
    supports_.push_back(support);
  }
}

void TrackModel::add_train() {
  const Vehicle vehicle = of_sides(input_.vehicle, sides());
  first_wheel_port_ = system_.add(std::make_unique<DensePart>(vehicle_structure(vehicle, input_.gravity)));
  first_wheel_link_ = system_.links();
  for (int k = 0; k < 4 * sides(); ++k) system_.add(Link{HertzContact{input_.wheel_constant}, {}, 0});
}

void TrackModel::place_train(double first_wheel) {
  const auto offsets = input_.vehicle.wheel_offsets();
  for (int wheel = 0; wheel < 4; ++wheel)
    for (int side = 0; side < sides(); ++side) {
      std::vector<LinkEnd> ends = rail_.at(first_wheel - offsets[at(wheel)], rail_port(0, side), 1);
      ends.push_back({first_wheel_port_ + wheel, -1.0});
      system_.move_ends(first_wheel_link_ + wheel * sides() + side, std::move(ends));
    }
}

void TrackModel::find_rest(double first_wheel) {
  place_train(first_wheel);
  system_.find_rest();
}

void TrackModel::step(double first_wheel) {
  place_train(first_wheel);
  system_.step();
}

double TrackModel::ground_force(const Support& s) const {
  return s.contacts > 0 ? 2.0 / sides() * system_.forces().segment(s.first_contact, s.contacts).sum() : 0;
}

double TrackModel::fastener_force(const Support& s) const {
  return 2.0 / sides() * system_.forces().segment(s.fastener, sides()).sum();
}

double TrackModel::gap(const Support& s) const {
  return s.contacts > 0 ? std::max(0.0, -system_.closings().segment(s.first_contact, s.contacts).maxCoeff())
                        : 0;
}

double TrackModel::wheel_force(int wheel) const {
  return system_.forces()(first_wheel_link_ + wheel * sides());
}

double TrackModel::wheel_height(int wheel) const {
  return displacement(first_wheel_port_ + wheel);
}

double TrackModel::rail_height(double x) const {
  double height = 0;
  for (const LinkEnd& end : rail_.at(x, rail_port(0, 0), 1)) height += end.weight * displacement(end.port);
  return height;
}

}  // namespace trackbed::fem
