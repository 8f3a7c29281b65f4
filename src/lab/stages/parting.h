// Stones that were put down overlapping part gently.
#pragma once

#include "io/progress.h"
#include "lab/simulation.h"

namespace trackbed {

/// Mean overlap of stones with stones, over the smaller stone's equal-volume radius [-]; and the largest.
struct Overlaps {
  double mean = 0, largest = 0;
  template <class A>
  void archive(A& a) {
    a(mean, largest);
  }
};
Overlaps overlaps_of_stones(const Simulation& sim);

/// Whether stones of this material give way to each other while they part: no wall or body is made of it.
bool is_softened(const Simulation& sim, int material);

/// From when it is opened to the end of the stage there is neither friction nor gravity, neither overlaps
/// nor places are limited, and stones move so little in a step that none is thrown.
class Parting {
 public:
  /// Stones of materials that no wall is made of meet each other with this share of their stiffness: they
  /// give way to each other rather than press each other through a wall of triangles. This share of all
  /// stones has its inertia raised: with all of them large stones part in as many steps as small ones.
  void open(Simulation& sim, double share_of_stiffness = 1, double scaled_share = usual_scaled_share);

  /// No point of a stone moves in a step by more than a hundredth of the smallest stone's radius, and from
  /// time to time all stand still: overlaps of any size come apart by small steps.
  void control(Simulation& sim) const;

  /// Whether the mean overlap is below this share.
  bool is_done(const Simulation& sim, double mean_overlap, double time_limit);

  double time(const Simulation& sim) const { return sim.state.time - start_; }  ///< since it began [s]
  const Overlaps& overlaps() const { return now_; }                             ///< when last looked at
  Awaited awaited(double mean_overlap) const;                                   ///< for the progress line
  template <class A>
  void archive(A& a) {
    a(start_, smallest_, overlap_limit_, now_);
  }

 private:
  double start_ = 0;          // [s]
  double smallest_ = 0;       // equal-volume radius [m]
  double overlap_limit_ = 0;  // of the bed when they have parted [-]
  Overlaps now_;
};

}  // namespace trackbed
