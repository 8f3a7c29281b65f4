#include "io/schema.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace trackbed {

bool Range::contains(double value) const {
  return !(above && !(value > *above)) && !(at_least && !(value >= *at_least)) &&
         !(below && !(value < *below)) && !(at_most && !(value <= *at_most));
}

std::string to_text(const Range& range, Dimension dimension) {
  const auto say = [&](double value) { return to_text(value, dimension); };
  if (range.at_least && range.at_most)
    return fmt::format("from {} to {}", say(*range.at_least), say(*range.at_most));
  std::string low, high;
  if (range.above) low = "above " + say(*range.above);
  if (range.at_least) low = "at least " + say(*range.at_least);
  if (range.below) high = "below " + say(*range.below);
  if (range.at_most) high = "at most " + say(*range.at_most);
  return low.empty() || high.empty() ? low + high : low + " and " + high;
}

std::string type_of(const Field& field) {
  const bool bare = field.dimension == Dimension::none;
  const std::string quantity =
      bare ? "number" : fmt::format("{} [{}]", name_of(field.dimension), si_unit_of(field.dimension));
  switch (field.type) {
    case FieldType::flag:
      return "true or false";
    case FieldType::integer:
      return "whole number";
    case FieldType::quantity:
      return quantity;
    case FieldType::vector:
      return "list of three: " + quantity;
    case FieldType::quantities:
      return "list: " + quantity;
    case FieldType::text:
      return "text";
    case FieldType::texts:
      return "list of texts";
    case FieldType::choice:
      return fmt::format("one of: {}", fmt::join(field.choices, ", "));
    case FieldType::choices:
      return fmt::format("list of: {}", fmt::join(field.choices, ", "));
    case FieldType::path:
      return "file";
    case FieldType::paths:
      return "files, or a pattern";
    case FieldType::section:
      return "table";
    case FieldType::table:
      return "tables by name";
    case FieldType::sequence:
      return "list of tables";
  }
  return {};
}

}  // namespace trackbed
