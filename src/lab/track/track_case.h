// A track case: a train on a railway track by finite elements, as data. A file with a table [track] is one.
#pragma once

#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "fem/track_model.h"
#include "io/read.h"
#include "io/schema.h"

namespace trackbed {

struct RailInput {
  std::string model = "timoshenko";
  double young = 2.1e11, poisson = 0.3, density = 7850;
  double area = 69.77e-4, second_moment = 2338e-8, shear_coefficient = 0.4;
  double damping = 0;  // [s]
  int elements = 4;
  std::string ends = "free";
};

struct FasteningInput {
  double compression = 1.2e8, tension = 1.2e11, damping = 5e4;
};

/// How a piece of concrete is modelled.
struct ConcreteInput {
  std::string model = "beam", hexahedra = "incompatible";
  double element = 0;
};

struct SleeperInput {
  double length = 2.4, width = 0.24, height = 0.2;
  double young = 3.6e10, poisson = 0.2, density = 2400;
  double rail_distance = 1.5;
  double contact = 1.2e9;
  int elements = 16, patches = 6;
  ConcreteInput concrete{.element = 0.075};
  double seat = 0.14;
};

struct SolidInput {
  double young = 0, poisson = 0, density = 0, depth = 0;
};

struct GroundInput {
  std::string model = "reduced";
  SolidInput ballast{1.2e8, 0.2, 1800, 0.3};
  SolidInput subgrade{1.8e8, 0.2, 1900, 0.975};
  double element = 0.075;
  double half_width = 1.8, crest = 1.8, slope = 1.5;
  std::string side = "roller", base = "fixed", ends = "absorbing";
  double mass_damping = 10, stiffness_damping = 5e-5;
  int krylov = 3;
  int krylov_beside_bridge = 8;
  double blow_frequency = 200;
  double window = 12;
};

struct SpringsInput {
  double stiffness = 1.1e8, damping = 1e5, mass = 100;
};

/// A sleeper's support as measured, in place of ground.
struct MeasuredInput {
  std::vector<double> sinking, force;
  double unloading = 0;
};

/// Sleepers by their numbers, both ends included; 0, the bridge, is none of them.
struct SleeperRange {
  int from = 0, to = 0;
};
void declare(Fields& f, SleeperRange& in);
std::vector<int> numbers_of(const SleeperRange& range);

/// Sleepers that lie on a bed of stones, known by its curve, in place of ground.
struct OwnSupportInput : SleeperRange {
  std::filesystem::path curve;  // read by support_curve.h
  double settlement = 0;        // [m]
};

struct SlabInput {
  double width = 4, depth = 1.6;
  double young = 3.5e10, poisson = 0.2, density = 2500;
  double damping = 1e-4;
  ConcreteInput concrete{.element = 0.3};
};

struct VehicleInput {
  double axle_load = 19e3;  // [kg]
  double bogie_distance = 20, wheelbase = 2.5;
  double bogie_mass = 2615, wheelset_mass = 1813;
  double car_gyration = 7.85, bogie_gyration = 0.75;
  double primary_stiffness = 4.2e5, primary_damping = 1.8e4;
  double secondary_stiffness = 4.7e5, secondary_damping = 3.5e4, secondary_bending = 1e4;
  double wheel_contact = 8.6e10;
};

struct TrackLayoutInput {
  double lead_in = 12, approach = 48, bridge = 24, departure = 48, run_out = 12;
  double spacing = 0.6;
  double settlement = 0;
  std::string width = "half";
  RailInput rail;
  FasteningInput fastening;
  SleeperInput sleeper;
  GroundInput ground;
  SpringsInput springs;
  std::optional<MeasuredInput> support;
  std::vector<OwnSupportInput> supports;
  SlabInput slab;
};

struct TrainInput {
  double speed = 40;
  double speed_up = 0.25;            // [s]
  std::optional<double> start, end;  // of the first wheel, from the start of the embankment [m]
  VehicleInput vehicle;
};

struct TrackNumericsInput {
  double time_step = 5e-4;
  double alpha = -0.05;
  double gravity = 9.81;
};

struct TrackRecordInput {
  double every = 2e-3;
  std::vector<double> sleepers;  // numbers of those in series.csv
  std::optional<double> paraview_every;
  double paraview_scale = 100;
};

struct TrackCaseInput {
  std::string title;
  TrackLayoutInput track;
  TrainInput train;
  TrackNumericsInput numerics;
  TrackRecordInput record;
};

void declare(Fields& f, TrackCaseInput& in);

/// Whether a file is a track case.
inline bool is_track_case(const Document& document) {
  return document.has("track");
}

/// Zones of every track, in this order; those without length have no sleepers.
enum class TrackZone { lead_in, approach, bridge, departure, run_out };

/// Number of sleepers, or fastenings, of each zone.
std::vector<int> sleepers_of(const TrackLayoutInput& track);

/// Name of a sleeper: counted from the bridge, negative before it, positive behind; "bridge N" on it.
int sleeper_number(const TrackLayoutInput& track, int support);

/// Its place along the whole track, or -1 when no embankment has a sleeper of this number.
int support_of_sleeper(const TrackLayoutInput& track, int number);

/// Where the first wheel starts and where the run ends [m from the start of the approach].
struct Journey {
  double start, end;
};
Journey journey_of(const TrackCaseInput& in);

/// Refuses, with file and line, what cannot be seen from one key: lengths that are no multiples of the
/// spacing, a train longer than the track.
void check_track(const Document& document, const TrackCaseInput& in);

/// Values of the model in SI. x counts from the start of the lead-in in it: see approach_start.
fem::TrackInput track_input(const TrackCaseInput& in);
double approach_start(const TrackLayoutInput& track);

/// Builds the model with its ground; ground that was worked out before is taken from `keep`. Calls `reducing`
/// with the embankment before it works out one, which may take minutes. Throws InputError, RunError.
fem::TrackModel make_track(const TrackCaseInput& in, const std::filesystem::path& keep,
                           const std::function<void(TrackZone)>& reducing = {});

}  // namespace trackbed
