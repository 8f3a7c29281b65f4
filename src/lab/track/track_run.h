// Runs a track case: rest, then the passage of the train.
#pragma once

#include "lab/run.h"
#include "lab/track/track_case.h"

namespace trackbed {

/// Leaves summary.json, series.csv, sleepers.csv and, where asked for, ParaView frames in options.out. Ground
/// that was worked out before is taken from options.keep. Throws InputError, RunError.
Summary run_track(const Document& document, const TrackCaseInput& in, const RunOptions& options);

}  // namespace trackbed
