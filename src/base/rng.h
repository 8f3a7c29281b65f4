// Random numbers that depend on the case's seed and on nothing else: the same on every machine.
#pragma once

#include <cstdint>
#include <pcg_random.hpp>
#include <string_view>

#include "base/vec.h"

namespace trackbed {

/// One stream of random numbers (PCG32, O'Neill 2014). Give each purpose its own stream, named by a word, so
/// that a new purpose does not shift the numbers of the others. The transforms are our own: those of the
/// standard library differ between its makers.
class Rng {
 public:
  Rng(std::uint64_t seed, std::string_view purpose);

  double uniform();                         ///< in [0, 1)
  double uniform(double low, double high);  ///< in [low, high)
  double normal();                          ///< mean 0, standard deviation 1 (Box-Muller)
  std::uint32_t index(std::uint32_t n);     ///< in 0 .. n-1, without bias
  Quat rotation();                          ///< uniform over all rotations (Shoemake 1992)

 private:
  pcg32 engine_;
};

}  // namespace trackbed
