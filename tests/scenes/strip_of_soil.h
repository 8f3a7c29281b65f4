// A coarse strip of ground under a few sleepers, small enough for tests.
#pragma once

#include "fem/soil.h"

namespace trackbed::fem {

/// Elements of 0.15 m: 3 m of ground, half 1.2 m wide with a shoulder, 0.3 m of ballast on 0.45 m of
/// subgrade.
inline SoilInput strip_of_soil() {
  SoilInput in;
  in.element_size = 0.15;
  in.length = 3;
  in.ballast_depth = 0.3;
  in.subgrade_depth = 0.45;
  in.half_width = 1.2;
  in.crest = 0.9;
  in.shoulder_slope = 1;
  in.sleepers = 5;
  in.first_sleeper = 0.3;
  in.sleeper_width = 0.3;
  in.sleeper_half_length = 0.9;
  return in;
}

}  // namespace trackbed::fem
