// The part of space a stage acts in: a region of the case, what lies outside it, or all.
#pragma once

#include <string>

#include "lab/case.h"
#include "lab/checks.h"

namespace trackbed {

struct Selection {
  std::string region;  // empty: all
  bool outside = false;

  bool is_all() const { return region.empty(); }
  bool contains(const Simulation& sim, const Vec3& point) const {
    return is_all() || sim.regions.at(region)(point) != outside;
  }
  /// Refuses a region that the case does not have; `here` is the key of the stage.
  void check(const Document& document, const CaseInput& experiment, const std::string& here) const {
    if (!is_all()) check_region(document, experiment, here + ".region", region);
  }
};

/// Declares the keys `region` and `outside`; `effect` ends the sentence "stones in it ...", `otherwise` tells
/// what happens without a region.
inline void declare_selection(Fields& f, Selection& in, const std::string& effect,
                              const std::string& otherwise = "all") {
  f.text("region", in.region, "stones whose centres lie in it " + effect + "; by default " + otherwise);
  f.flag("outside", in.outside, "those outside the region instead");
  f.check(!in.outside || !in.region.empty(), "outside", "there is no region to be outside of", "give region");
}

}  // namespace trackbed
