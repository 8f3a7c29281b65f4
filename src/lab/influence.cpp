#include "lab/influence.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <functional>
#include <sstream>

#include "base/error.h"
#include "io/csv.h"

namespace trackbed {
namespace {

using Index = std::size_t;

std::vector<std::string> fields_of(const std::string& line) {
  std::vector<std::string> fields;
  std::istringstream in(line);
  for (std::string field; std::getline(in, field, ',');) {
    while (!field.empty() && (field.back() == '\r' || field.back() == ' ')) field.pop_back();
    fields.push_back(field);
  }
  return fields;
}

/// Where the columns of a vector or a number stand in the table.
class StoneTable {
 public:
  explicit StoneTable(const std::filesystem::path& path) : path_(path), in_(path) {
    if (!in_) throw InputError(fmt::format("{}: cannot be read", path.string()));
    std::string line;
    std::getline(in_, line);
    headers_ = fields_of(line);
  }

  Index column(const std::string& name) const {
    const auto found = std::ranges::find_if(headers_, [&](const std::string& header) {
      return header == name || header.starts_with(name + " [");
    });
    if (found == headers_.end())
      throw InputError(fmt::format("{}: there is no column {}: is it a stones.csv?", path_.string(), name));
    return static_cast<Index>(found - headers_.begin());
  }

  bool next() {
    std::string line;
    if (!std::getline(in_, line)) return false;
    ++line_;
    row_ = fields_of(line);
    return true;
  }

  double number(Index column) const {
    try {
      if (column < row_.size()) return std::stod(row_[column]);
    } catch (const std::exception&) {
    }
    throw InputError(
        fmt::format("{}:{}: there is no number in the column {}", path_.string(), line_, headers_[column]));
  }

 private:
  std::filesystem::path path_;
  std::ifstream in_;
  std::vector<std::string> headers_, row_;
  int line_ = 1;
};

}  // namespace

InfluenceField read_influence(const std::filesystem::path& stones, const std::string& name) {
  StoneTable table(stones);
  const bool by_displacement = name == "displacement";
  const Index place = table.column("x"), shift = table.column("displacement_x");
  const Index value = by_displacement ? shift : table.column(name);
  InfluenceField field;
  field.name = name;
  field.dimension = by_displacement ? Dimension::length : Dimension::stress;
  while (table.next()) {
    const auto vector = [&](Index first) {
      return Vec3(table.number(first), table.number(first + 1), table.number(first + 2));
    };
    const Vec3 moved = vector(shift);
    field.places.push_back(vector(place) - moved);
    field.values.push_back(by_displacement ? moved.norm() : table.number(value));
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
