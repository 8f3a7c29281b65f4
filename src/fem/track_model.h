// A railway track in the vertical plane with a train on it: rails, fasteners, sleepers, what they lie on, and
// the vehicle, as parts and links of one CoupledSystem.
//
// A track is a row of zones. In a zone sleepers lie on ground (a part of its own, or nothing that gives), or
// rails are fastened to a bridge. All values are those of one half (one rail) unless said otherwise; a track
// of two halves joined by their sleepers can be built to check that a half is enough.
#pragma once

#include <map>
#include <memory>
#include <vector>

#include "fem/beam.h"
#include "fem/coupled_system.h"
#include "fem/hexahedron.h"
#include "fem/vehicle.h"

namespace trackbed::fem {

/// How a piece of concrete is modelled: as a Timoshenko beam, or of hexahedra.
struct ConcreteModel {
  bool solid = false;
  double element = 0;                    // edges of hexahedra [m]
  HexKind kind = HexKind::incompatible;  // and how they strain
};

/// A whole sleeper: across the track.
struct Sleeper {
  double length = 2.4, width = 0.24, height = 0.2;       // across, along the track, up [m]
  double young = 3.6e10, poisson = 0.2, density = 2400;  // [Pa], [-], [kg/m^3]
  double rail_distance = 1.5;                            // between the rails' middles [m]
  int elements = 16;                                     // of a half
  int patches = 6;  // strips of equal length in which a half touches the ground
  ConcreteModel model{false, 0.075};
  double seat = 0.14;  // of a solid one: part of its length under the foot of a rail [m]

  double mass() const { return length * width * height * density; }
};

/// A simply supported slab along the track. Displacements count from its
/// rest under its own weight.
struct Slab {
  double width = 4, depth = 1.6;                         // of the whole section [m]
  double young = 3.5e10, poisson = 0.2, density = 2500;  // [Pa], [-], [kg/m^3]
  double damping = 0;                                    // share of the stiffness [s]
  ConcreteModel model{false, 0.3};
};

/// Springs under a half of a sleeper in place of ground: each patch stands on a mass with spring and dashpot.
struct Springs {
  double stiffness = 1.1e8;  // of all patches of a half together [N/m]
  double damping = 1e5;      // likewise [N s/m]
  double mass = 100;         // that moves with them [kg]
};

struct Zone {
  enum class Kind { ground, bridge } kind = Kind::ground;
  int sleepers = 0;  // or fastenings on a bridge
  std::unique_ptr<Part>
      ground;       // ports: mean sinking of each patch, sleeper after sleeper; nothing: it does not give
  LinkLaw contact;  // between a half of a sleeper and ground
  std::vector<double> gaps;             // under each sleeper before it hangs or sinks [m]; empty: none
  std::map<int, LinkLaw> own_supports;  // of sleepers that lie on these in place of ground, by their places
};

struct TrackInput {
  double spacing = 0.6;        // of sleepers [m]
  double first_sleeper = 0.3;  // behind the start of the first zone [m]
  BeamSection rail;
  int elements_per_bay = 4;  // of rails, even
  bool clamped_rail_ends = false;
  ClampedSpring fastener;
  Sleeper sleeper;
  Slab slab;
  Vehicle vehicle;
  double wheel_constant = 9e10;  // Hertz [N/m^1.5]
  double gravity = 9.81;         // [m/s^2]
  bool whole_width = false;
};

/// Ground of springs for so many sleepers.
std::unique_ptr<Part> make_springs(const Springs& springs, int sleepers, const Sleeper& sleeper,
                                   bool whole_width);

class TrackModel {
 public:
  /// Throws std::invalid_argument when zones do not fit (two bridges side by side, ports of ground).
  TrackModel(const TrackInput& input, std::vector<Zone> zones);

  /// Rest with the train standing, its first wheel at x [m from the start of the first zone].
  void find_rest(double first_wheel);
  void move_by(const TimeScheme& scheme) { system_.move_by(scheme); }
  /// A step in time at whose end the first wheel is at x.
  void step(double first_wheel);

  /// Where the first wheel may be so that all are on the rails.
  double first_start() const { return rail_.nodes().front() + input_.vehicle.wheel_offsets().back(); }
  double last_end() const { return rail_.nodes().back(); }

  /// A sleeper, or a fastening on a bridge.
  struct Support {
    double x = 0;                            // [m]
    int zone = 0;                            // of those given
    Index fastener = 0;                      // link; of the second rail: the next one
    Index first_contact = -1, contacts = 0;  // links; none on a bridge
    Index seat = 0;                          // port under the rail, of sleeper or bridge
    Index rail_port = 0;
  };
  const std::vector<Support>& supports() const { return supports_; }

  /// Force of a whole sleeper on the ground [N]; zero on a bridge.
  double ground_force(const Support& support) const;
  /// Force of both rails on a sleeper or bridge [N].
  double fastener_force(const Support& support) const;
  /// Least distance between sleeper and ground [m]; 0 where they touch.
  double gap(const Support& support) const;
  /// Force of a wheel of one side on the rail [N], from the front.
  double wheel_force(int wheel) const;
  double wheel_height(int wheel) const;  // how far the wheelset has come up [m]
  double rail_height(double x) const;

  const CoupledSystem& system() const { return system_; }
  const TrackInput& input() const { return input_; }
  const Beam& rail() const { return rail_; }
  double displacement(Index port) const { return system_.displacements()(port); }
  double velocity(Index port) const { return system_.velocities()(port); }

 private:
  int sides() const { return input_.whole_width ? 2 : 1; }
  void add_ground(Zone& zone, int number);
  void add_bridge(const Zone& zone, int number);
  std::vector<Index> add_slab(int fastenings);
  void add_train();
  void place_train(double first_wheel);
  Index rail_port(Index port, int side) const { return first_rail_ + side * rail_.ports() + port; }

  TrackInput input_;
  CoupledSystem system_;
  Beam rail_;
  Index first_rail_ = 0, first_wheel_port_ = 0, first_wheel_link_ = 0;
  std::vector<Support> supports_;
  double next_x_ = 0;  // of the support to be added
};

}  // namespace trackbed::fem
