// Stone sizes by a grading curve.
#pragma once

#include <vector>

#include "base/rng.h"
#include "lab/case.h"

namespace trackbed {

/// Sizes [m] of stones whose volumes (of balls, or of discs in the plane) add up to `solid_volume` [m^3] with
/// the shares by mass that the grading asks for: within a band sizes are drawn uniformly by number; the last
/// stone of a band is taken when it brings the band's volume nearer to its share. Largest first.
std::vector<double> draw_sizes(const GradingInput& grading, const Space& space, double solid_volume,
                               Rng& rng);

/// The smallest size that may be drawn [m].
double smallest_size(const GradingInput& grading);

/// Scale that gives a stone of this template the size [m], measured as the grading says.
double scale_to_size(const GradingInput& grading, const Space& space, const ClumpTemplate& stone,
                     double size);

/// Share of volume that passes each sieve, of stones of these sizes [-].
std::vector<double> passing(const GradingInput& grading, const Space& space,
                            const std::vector<double>& sizes);

/// The same as results of a stage, one a sieve, called by the sieve of the file, before its scale.
std::vector<Result> passing_results(const GradingInput& grading, const Space& space,
                                    const std::vector<double>& sizes);
/// Says that a stage gives them.
void declare_passing(Fields& f);

}  // namespace trackbed
