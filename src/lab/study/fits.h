// Straight lines through what the members of a study found.
#pragma once

#include <filesystem>
#include <vector>

#include "lab/study/results.h"

namespace trackbed {

/// fits.csv: a row for each fit of the study and each group of conditions that differ in its x alone: the
/// changed keys, number of members, intercept, slope and, where both are of one unit, the slope's angle, each
/// with its 95 % interval, and R^2. Every finished member is a point. Writes nothing for a study without
/// fits. Throws InputError for an x that is no quantity of the case.
void write_fits(const StudyInput& study, const std::vector<Condition>& conditions,
                const std::vector<Member>& members, const std::vector<Outcome>& outcomes,
                const std::filesystem::path& path);

}  // namespace trackbed
