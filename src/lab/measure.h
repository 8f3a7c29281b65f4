// What is measured: a name, a unit, a line of meaning, a function of the simulation. The same measures make
// the columns of series.csv and the entries of summary.json. To add one: a function in src/lab/measures/ and
// a row in measures/table.cpp.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "lab/simulation.h"
#include "lab/stage.h"

namespace trackbed {

struct Measure {
  std::string name;
  Dimension dimension = Dimension::none;
  std::string meaning;
  std::function<double(const Simulation&)> value;
};

/// All measures of a simulation: the general ones, and those of each wall and body ("sleeper.force_z").
std::vector<Measure> measures_of(const Simulation& sim);

/// A body of which only the measures are wanted, before it is built: a plane stands for its shape.
void add_body_by_name(Simulation& sim, const std::string& name);

/// Those of them with these names, in this order. Throws InputError for a name that is no measure, with the
/// nearest.
std::vector<Measure> measures_called(const Simulation& sim, const std::vector<std::string>& names);

/// What the user may have meant by a name; nothing when it is a measure.
std::optional<std::string> hint_for_measure(const Simulation& sim, const std::string& name);

/// Counts of contact forces between the limits [N]: below the first, between, above the last; contacts
/// between pebbles, stone-stone and stone-wall.
std::vector<int> force_histogram(const Simulation& sim, const std::vector<double>& limits);

/// Height of the bed's surface above the floor z = 0: mean over a 20 mm grid of the highest stone point, a
/// tenth of the highest values dropped; `where` limits it in x and y [m].
double bed_surface(const Simulation& sim, const Eigen::AlignedBox2d& where);

}  // namespace trackbed
