// A case: the whole experiment as data, and the simulation made of it.
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "io/read.h"
#include "io/schema.h"
#include "lab/simulation.h"
#include "lab/stage.h"

namespace trackbed {

/// Share by mass that passes each sieve (EN 933-1); docs/theory.md.
struct GradingInput {
  std::vector<double> sieves{0.0224, 0.0315, 0.040, 0.050, 0.063};  // [m], ascending
  std::vector<double> passing{0, 0.07, 0.33, 0.71, 1};              // [-], from 0 to 1
  std::string size = "volume";                                      // what a sieve measures: volume | sieve
  double scale = 1;                                                 // on all sieves
  double sieve(std::size_t k) const { return scale * sieves[k]; }   // [m]
};

/// Where stone shapes come from and how finely they are filled with pebbles.
struct ShapesInput {
  std::vector<std::filesystem::path> files;  // empty: made by the generator
  int shapes = 10;                           // made by the generator
  std::optional<std::uint64_t> seed;         // of the generator; the case's where there is none
  std::string fidelity = "clump";            // clump | ball | stand_in
  double distance = 2.6;                     // [rad]
  double ratio = 0.3;
  int max_pebbles = 0;
  bool enlarge = false;           // pebbles, to the volume of the mesh
  double wear = 0;                // of edges, over the stone's mean radius
  double largest_elongation = 3;  // stones with a longer L/S are left out
  std::string material = "ballast";
};

/// The stones of the experiment; further sets of shapes that stages may name.
struct StonesInput : ShapesInput {
  GradingInput grading;
  std::map<std::string, ShapesInput> sets;
};

struct MaterialInput {
  double kn = 0, ks = 0, friction = 0, rolling_friction = 0, density = 0;
};

struct DashpotInput {
  double normal = 0, shear = 0;
  std::string mode = "full";
};

struct ContactInput {
  std::string law = "linear";
  std::string inherit = "series";
  DashpotInput dashpot;
};

/// A part of space, chosen by its kind (box, mesh, field).
struct RegionInput {
  std::string here;  // where it stands in the file, for errors found later
  virtual ~RegionInput() = default;
  /// Tells whether a point [m] lies in it. Throws InputError when a file cannot be used.
  virtual Region make() const = 0;
};

const Kinds<RegionInput>& region_kinds();

/// A wall, chosen by its kind (plane, box, tray, mesh).
struct WallInput {
  std::string material;
  std::string here;  // where it stands in the file, for errors found later
  virtual ~WallInput() = default;
  /// Adds it to the simulation under its name.
  virtual void build(const std::string& name, int material_index, Simulation& sim) const = 0;
  /// Whether the stones are filled into it.
  virtual bool is_container() const { return false; }
  /// Whether it is one of several that together are the container.
  virtual bool is_part_of_container() const { return false; }
};

/// A body with mass, such as the sleeper, chosen by its kind (block, cylinder, mesh). It is placed by a
/// stage.
struct BodyInput {
  std::string material;
  std::string here;
  std::optional<double> mass;  // [kg]; default: volume x density of the material
  std::vector<std::string> free{"x", "y", "z", "turn_x", "turn_y", "turn_z"};
  virtual ~BodyInput() = default;
  virtual TriangleMesh shape() const = 0;
};

const Kinds<WallInput>& wall_kinds();
const Kinds<BodyInput>& body_kinds();

struct NumericsInput {
  Vec3 gravity{0, 0, -9.81};
  double damping = 0.7;
  double safety = 0.8;
  double largest_travel = 0.02;
  std::optional<double> time_step;
  std::optional<double> skin, margin;
  double overlap_limit = 0.25;
  double speed_limit = 100;
};

/// What is written, and when; see lab/recorder.h.
struct RecordInput {
  double every = 1e-3;                                         // between two rows of series.csv [s]
  std::vector<std::string> measures;                           // further columns of series.csv
  std::vector<double> force_bins{100, 500, 1000, 2000, 3000};  // limits of the histogram [N]
  std::vector<std::string> stages;                             // at whose ends is written; empty: all
  std::vector<std::string> keep;                               // whose ends are kept for other runs
  bool tables = true;                                          // contacts.csv and stones.csv at stage ends
  std::optional<double> paraview_every;                        // [s]; default: at stage ends only
  std::string paraview_stones = "surfaces";                    // surfaces | pebbles | none
  bool picture = true;                                         // bed.png and others at stage ends
  std::optional<double> displacement_scale;                    // red in displacements.png [m]
};

struct CaseInput {
  std::string title;
  std::uint64_t seed = 1;
  std::optional<double> thickness;  // of a model in the plane [m]
  StonesInput stones;
  std::map<std::string, MaterialInput> materials;
  ContactInput contact;
  std::map<std::string, OneOf<WallInput>> walls;
  std::map<std::string, OneOf<BodyInput>> bodies;
  std::map<std::string, OneOf<RegionInput>> regions;
  NumericsInput numerics;
  RecordInput record;
  std::vector<OneOf<StageInput>> stages;
};

void declare(Fields& f, CaseInput& in);

/// Checks what the declaration alone cannot (names that must exist, shapes that must be readable) and makes
/// the simulation: materials, stone templates, walls; bodies stand far above until a stage places them,
/// stones are added by the fill stage. Throws InputError with file and line.
Simulation make_simulation(const Document& document, const CaseInput& experiment);

}  // namespace trackbed
