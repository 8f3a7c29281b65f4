// Conditions that a stage may change until its end: friction, damping, inertia.
#pragma once

#include <optional>

#include "io/schema.h"
#include "lab/simulation.h"

namespace trackbed {

struct ConditionsInput {
  std::optional<double> friction, damping;
  bool scaled_step = false;
  double scaled_share = usual_scaled_share;
};

/// The keys of all of them.
void declare(Fields& f, ConditionsInput& in);

/// The key scaled_share of a stage whose step is always scaled.
void declare_scaled_share(Fields& f, double& share);

/// To be called when the stage is opened; the run brings back what was there before.
void apply(const ConditionsInput& in, Simulation& sim);

}  // namespace trackbed
