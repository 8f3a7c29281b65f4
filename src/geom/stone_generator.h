// Stones out of nothing: seeded shapes of crushed rock, so that the program runs without scans.
#pragma once

#include <cstdint>
#include <string>

#include "geom/mesh.h"

namespace trackbed {

/// A number drawn evenly between two limits.
struct Interval {
  double low, high;
};

/// What stones are to be like. The defaults come near the means of scanned rubble (sphericity 0.77, convexity
/// 0.87, I/L 0.71, S/I 0.59).
struct StoneRecipe {
  Interval faces{15, 25};           // planes that cut the stone out of the rock
  Interval elongation{0.55, 0.87};  // I / L
  Interval flatness{0.39, 0.77};    // S / I
  double largest_l_over_s = 3;      // flakier or longer stones are drawn again
  Interval hollows{8, 13};  // shell-shaped scars, as chips leave them; with roughness 0 and none of them
                            // the stone is convex
  Interval hollow_depth{0.06, 0.25};  // in mean radii
  double roughness = 0.05;            // amplitude of the uneven surface, in mean radii
  double sieve_size = 1;              // of every stone [m]
};

/// The recipe of plane-cut stones without a hollow.
StoneRecipe convex_recipe();

/// Stone number `index` of a seed: the same for ever, whichever other stones are made. Always a solid,
/// centred on its centre of mass, with its longest side along x and its shortest along z. Throws InputError
/// for a recipe that cannot be met.
TriangleMesh generate_stone(const StoneRecipe& recipe, std::uint64_t seed, int index);

}  // namespace trackbed
