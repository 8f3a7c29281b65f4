// What can be thrown away at any step and worked out again from Model and State: the contact search, and the
// results of the step in hand. An empty Workspace is always valid.
#pragma once

#include <algorithm>
#include <array>
#include <vector>

#include "base/lanes.h"
#include "base/vec.h"
#include "dem/model.h"
#include "dem/state.h"

namespace trackbed {

/// Where the bodies of a pair were when its candidates were last looked for.
struct PairSearch {
  Quat turn = Quat::Identity();  // of body 2 relative to body 1, then
  Vec3 offset = Vec3::Zero();    // of body 2 in the frame of body 1, then
  double range = -1;             // motion since then that the list allows; negative: there is none yet [m]
};
static_assert(sizeof(PairSearch) == 64);  // a large bed has millions

/// Pebble pairs among which the candidates of a pair are, while the motion of its bodies and the skin of
/// the candidates together are less than the range.
struct NearPebbles {
  std::vector<PebblePair> pairs;
  PairSearch search;
};

/// Two pebbles that may touch.
struct Candidate {
  int i, j;        // clumps
  int a, b;        // pebbles, in Workspace::pebbles
  int sum_j;       // where in Workspace::sums the effect on j goes; that on i goes to i
  int properties;  // of the pair of materials, in PairTable
};

/// Tells when a block must look at its pairs: not before one of its own stones has gone far enough, whatever
/// stones elsewhere do. Stones are watched by groups of consecutive ones, which lie near each other.
struct Watch {
  static constexpr std::size_t group = 16;  // stones
  std::vector<int> groups;                  // those of the block's stones
  double way = 0;           // none of these stones has gone farther since the pairs were made [m]
  double quiet_until = -1;  // no pair is due before way is there [m]

  void add(int stone) {
    const int of_stone = stone / static_cast<int>(group);
    if (std::find(groups.rbegin(), groups.rend(), of_stone) == groups.rend()) groups.push_back(of_stone);
  }
  /// Adds the way of the last step; whether a pair may be due.
  bool step(const std::vector<double>& group_way, double further = 0) {
    double longest = 0;
    for (int k : groups) longest = std::max(longest, group_way[static_cast<std::size_t>(k)]);
    way += longest + further;
    return way >= quiet_until;
  }
};

/// Beside a PairBlock.
struct PairGeometry {
  std::vector<PairSearch> search;
  std::vector<NearPebbles> near;      // empty while no pair has needed one
  std::vector<double> due;            // sum of both clumps' travel at which their motion must be measured [m]
  std::vector<Candidate> candidates;  // beside the keys
  bool is_centred = false;  // all pebbles of stones with candidates stand in the centres of their stones
  int first_pair = 0;       // number of its first pair, through all blocks
  Watch watch;
};

/// A pebble, and the facets near it.
struct WallCandidate {
  Vec3 centre;                // in the frame of the clump [m]
  double radius;              // [m]
  double gap;                 // to the wall when the pair was searched [m]
  int first_facet, n_facets;  // in WallGeometry::facets
};

/// Beside a WallBlock.
struct WallGeometry {
  std::vector<PairSearch> search;
  std::vector<double>
      tested;               // candidates of a pair with a larger gap cannot touch before the pair is due [m]
  std::vector<double> due;  // sum of clump's and wall's travel at which their motion must be measured [m]
  std::vector<WallCandidate> candidates;
  std::vector<int> facets;
  int first_pair = 0;  // number of its first pair, through all blocks
  Watch watch;
};

/// A stone as its contacts see it: rows of four numbers.
struct alignas(64) StoneMotion {
  Row position;  // and the scale on the template's lengths
  Row velocity;  // and the mass
  Row spin;      // and 0
  Row turn;      // principal axes to world: the unit quaternion x, y, z, w
};

/// Sum of what contacts do to a clump.
struct alignas(64) ForceSum {
  Row force = 0.0;   // [N], and 0
  Row moment = 0.0;  // about its centre of mass [N m], and the friction loss of contacts of which it is i [J]
};

/// What the contacts of a clump with a wall do to the clump.
struct WallResult {
  Vec3 force = Vec3::Zero();   // [N]
  Vec3 moment = Vec3::Zero();  // about its centre of mass [N m]
  Losses losses;
};

/// What contacts of some clumps do to a wall.
struct alignas(64) WallSum {
  Vec3 force = Vec3::Zero();   // [N]
  Vec3 moment = Vec3::Zero();  // about its frame's origin [N m]
};

/// Blocks of walls that one thread works on first, in Workspace::wall_block_order.
struct alignas(64) WallQueue {
  int next, end;
};

/// Where a pair lies.
struct PairPlace {
  int block, index;
};

/// Seconds spent since the start, for the profile.
struct Profile {
  double search = 0, forces = 0, gather = 0, motion = 0;
};

struct Workspace {
  // Of each clump.
  std::vector<StoneMotion> motion;
  std::vector<Row> pebbles;             // centre and radius, at scale 1, of all templates one after the other
  std::vector<int> first_pebble;        // of each template
  std::vector<char> is_centred;         // of each template: all its pebbles stand in its centre of mass
  std::vector<double> bound;            // bounding radius [m]
  std::vector<double> swing;            // bound, or 0 where turning moves no pebble [m]
  std::vector<double> travel;           // no pebble of it has gone farther since the start [m]
  std::vector<Vec3> position_at_build;  // when the pairs were made [m]
  // Of each wall.
  std::vector<Mat3> wall_rotation;
  std::vector<double> wall_travel;
  std::vector<double> wall_travel_at_build;

  double skin = 0, margin = 0;    // [m]
  bool pairs_are_valid = false;   // false: make all pairs anew before the next forces
  int steps_of_pairs = 0;         // since they were made
  double pairs_good_until = 0;    // no stone outside the pairs can touch before way + wall_way is there [m]
  double way = 0;                 // no stone's travel has grown by more since the start [m]
  double wall_way = 0;            // nor has any wall's [m]
  std::vector<double> group_way;  // longest way in the last step, of each group of stones (Watch) [m]
  double wall_step_way = 0;       // of any wall [m]

  std::vector<PairGeometry> pair_geometry;  // beside State::pair_blocks
  std::vector<WallGeometry> wall_geometry;  // beside State::wall_blocks

  // Patches: runs of consecutive clumps, each with all pairs of which they are i, that one thread works on at
  // a time. Their size depends on the number of clumps alone, and is a multiple of that of a watched group.
  int patch_size = 1;
  std::vector<int> first_block_of_patch;
  // Of each clump, from the pairs of its own patch; then, patch after patch, of each clump of another patch
  // that is j of one of its pairs.
  std::vector<ForceSum> sums;
  std::vector<Losses> rare_losses;  // of each clump: rolling and dashpots [J]
  // Of each pair of a clump and a wall; of groups of them.
  std::vector<WallResult> wall_results;
  std::vector<WallSum> wall_sums;

  // Pairs of each clump: a range of pairs where it is i, a list of pairs where it is j, both ascending.
  std::vector<int> first_pair, first_entry, entries;
  std::vector<PairPlace> pair_places;
  // Of each clump: the sums that come from other patches, ascending. Of each pair: where the effect on j
  // goes.
  std::vector<int> first_sum, outer_sums, sum_of_pair;
  // Of each patch: its range of these sums.
  std::vector<int> first_sum_of_patch;
  // Wall pairs of each clump in ascending order of the wall.
  std::vector<int> first_wall_entry, wall_entries;
  std::vector<PairPlace> wall_pair_places;
  std::vector<int> sum_of_wall_pair, first_sum_of_wall;
  // Blocks of walls by the patch in which they lie, roughly; and who works on them next.
  std::vector<int> wall_block_order, first_wall_block_of_patch;
  std::vector<WallQueue> wall_queues;

  int touching = 0;  // contacts in the last step
  Profile profile;

  int patches() const { return static_cast<int>(first_block_of_patch.size()) - 1; }
  /// Clumps of a patch: from its first to the first of the next.
  std::size_t first_clump(int patch) const {
    return std::min(static_cast<std::size_t>(patch) * static_cast<std::size_t>(patch_size), motion.size());
  }
};

}  // namespace trackbed
