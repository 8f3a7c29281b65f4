// Where a bed is stirred: the influential area, in which stones need their shapes (APSS).
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "base/units.h"
#include "base/vec.h"

namespace trackbed {

/// What a stage did to each stone, at the places where the stones were when it began.
struct InfluenceField {
  std::vector<Vec3> places;    // [m]
  std::vector<double> values;  // SI
  std::string name;            // of the value: displacement, mean_stress
  Dimension dimension = Dimension::none;
};

/// Reads the field from the stones.csv of a stage; `name`: displacement, its length is taken, or mean_stress.
/// Throws InputError when the table lacks the columns or a line is broken.
InfluenceField read_influence(const std::filesystem::path& stones, const std::string& name);

/// The value above which this share (0 to 1) of the stones lies, up to one stone and equal values.
double threshold_for(const InfluenceField& field, double share);

/// Writes the field as regions of kind field read it. Throws RunError when that cannot be written.
void write_influence(const InfluenceField& field, const std::filesystem::path& path);

}  // namespace trackbed
