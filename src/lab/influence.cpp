#include "lab/influence.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <vector>

#include "base/error.h"
#include "io/csv.h"

namespace trackbed {
using Index = std::size_t;

InfluenceField read_influence(const std::filesystem::path& stones, const std::string& name) {
  const CsvTable table(stones);
  const auto vectors = [&](const std::string& prefix) {
    std::vector<Vec3> all(table.rows());
    for (Eigen::Index axis = 0; axis < 3; ++axis) {
      const auto part = table.numbers(prefix + "xyz"[axis], Dimension::length);
      for (Index k = 0; k < all.size(); ++k) all[k][axis] = part[k];
    }
    return all;
  };
  const std::vector<Vec3> places = vectors(""), moved = vectors("displacement_");
  const bool by_displacement = name == "displacement";
  InfluenceField field;
  field.name = name;
  field.dimension = by_displacement ? Dimension::length : Dimension::stress;
  if (!by_displacement) field.values = table.numbers(name, field.dimension);
  for (Index k = 0; k < places.size(); ++k) {
    field.places.push_back(places[k] - moved[k]);
    if (by_displacement) field.values.push_back(moved[k].norm());
  }
  if (field.places.empty()) throw InputError(fmt::format("{}: holds no stones", stones.string()));
  return field;
}

double threshold_for(const InfluenceField& field, double share) {
  std::vector<double> sorted = field.values;
  std::ranges::sort(sorted, std::greater<>());
  const auto above = static_cast<Index>(std::lround(share * static_cast<double>(sorted.size())));
  // Halfway between the last value that shall lie above and the first that shall not.
  if (above == 0) return sorted.front();
  if (above >= sorted.size()) return std::nextafter(sorted.back(), -HUGE_VAL);
  return 0.5 * (sorted[above - 1] + sorted[above]);
}

void write_influence(const InfluenceField& field, const std::filesystem::path& path) {
  CsvWriter table(path, {{"x", Dimension::length},
                         {"y", Dimension::length},
                         {"z", Dimension::length},
                         {field.name, field.dimension}});
  for (Index k = 0; k < field.places.size(); ++k) {
    const Vec3& x = field.places[k];
    table.add_row({x.x(), x.y(), x.z(), field.values[k]});
  }
}

}  // namespace trackbed
