// What can be thrown away at any step and worked out again from Model and State: the contact search, and the
// results of the step in hand. An empty Workspace is always valid.
#pragma once

#include <vector>

#include "base/vec.h"
#include "dem/model.h"
#include "dem/state.h"

namespace trackbed {

/// When the candidates of a pair were last looked for, and when to look again.
struct PairSearch {
  Vec3 offset = Vec3::Zero();    // of body 2 in the frame of body 1, then
  Quat turn = Quat::Identity();  // of body 2 relative to body 1, then
  double range = -1;             // motion since then that the list allows; negative: there is none yet [m]
  double due = -1;               // sum of both bodies' travel at which their motion must be measured [m]
};

/// Candidate geometry of a PairBlock: for each pair of n candidates eight columns of n numbers, namely place
/// of pebble a in the frame of i (3), of pebble b in the frame of j (3), sum of radii, radius of a.
struct PairGeometry {
  static constexpr int columns = 8;
  std::vector<PairSearch> search;
  std::vector<double> columns_of_pairs;
};

/// Candidate geometry of a WallBlock: the pebble, and the facets near it.
struct WallCandidate {
  Vec3 centre;                // in the frame of the clump [m]
  double radius;              // [m]
  int first_facet, n_facets;  // in WallGeometry::facets
};
struct WallGeometry {
  std::vector<PairSearch> search;
  std::vector<WallCandidate> candidates;
  std::vector<int> facets;
};

/// What the contacts of one clump pair did in this step; nothing until they are looked at. Moments about the
/// centres of mass.
struct PairResult {
  Vec3 force = Vec3::Zero();     // on clump j, and the opposite on i [N]
  Vec3 moment_i = Vec3::Zero();  // [N m]
  Vec3 moment_j = Vec3::Zero();  // [N m]
  Losses losses;                 // [J]
  int contacts = 0;              // touching
};

/// The same for a clump and a wall.
struct WallResult {
  Vec3 force = Vec3::Zero();         // on the wall [N]
  Vec3 moment_clump = Vec3::Zero();  // on the clump about its centre of mass [N m]
  Vec3 moment_wall = Vec3::Zero();   // on the wall about its frame's origin [N m]
  Losses losses;
  int contacts = 0;
};

/// Seconds spent since the start, for the profile.
struct Profile {
  double search = 0, forces = 0, gather = 0, motion = 0;
};

struct Workspace {
  // Of each clump.
  std::vector<Mat3> rotation;           // body axes to world
  std::vector<double> bound;            // bounding radius [m]
  std::vector<double> travel;           // length of way of its farthest point since the start [m]
  std::vector<Vec3> position_at_build;  // when the pairs were made [m]
  // Of each wall.
  std::vector<Mat3> wall_rotation;
  std::vector<double> wall_travel;
  std::vector<double> wall_travel_at_build;

  double skin = 0, margin = 0;   // [m]
  bool pairs_are_valid = false;  // false: make all pairs anew before the next forces
  double largest_shift2 = 0;     // of a clump since the pairs were made, squared [m^2]

  std::vector<PairGeometry> pair_geometry;  // beside State::pair_blocks
  std::vector<WallGeometry> wall_geometry;  // beside State::wall_blocks
  std::vector<PairResult> pair_results;     // by pair, through all blocks
  std::vector<WallResult> wall_results;

  // Pairs of each clump in ascending order of the other: entry = 2 x pair + (1 when the clump is j).
  std::vector<int> first_entry, entries;
  // Wall pairs of each clump in ascending order of the wall.
  std::vector<int> first_wall_entry, wall_entries;
  std::vector<int> first_pair_of_wall;  // range in the wall pairs

  int touching = 0;  // contacts in the last step
  Profile profile;
};

}  // namespace trackbed
