#include "io/values.h"

#include <fmt/format.h>

#include <cmath>

#include "io/files.h"
#include "io/nearest.h"

namespace trackbed {
namespace fs = std::filesystem;
namespace {

/// Reads the value of one field. `name` is the key, or "an entry of" it.
class ValueReader {
 public:
  ValueReader(const Field& field, Reading& reading)
      : field_(field), reading_(reading), name_(field.key.name) {}
  std::optional<Value> read(const Node& node);

 private:
  template <class T>
  std::optional<Value> list(const Node& node, std::optional<T> (ValueReader::*entry)(const Node&));
  std::optional<double> quantity(const Node& node);
  std::optional<std::int64_t> integer(const Node& node);
  std::optional<std::string> text(const Node& node);
  std::optional<std::string> choice(const Node& node);
  std::optional<fs::path> path(const Node& node);
  std::optional<Value> vector(const Node& node);
  std::optional<Value> paths(const Node& node);
  void add_files(const Node& node, std::vector<fs::path>& files);

  bool has_type(const Node& node, Node::Type type, std::string_view wanted, const std::string& hint);
  bool in_range(double value, const Node& node);
  fs::path folder_of(const Node& node) const {
    return node.place.override_index >= 0 ? fs::path() : reading_.folder;
  }
  std::string place_looked_at(const fs::path& full, const Node& node) const;
  void wrong(const Node& node, std::string problem, std::string hint) {
    reading_.errors.add(node.place, std::move(problem), std::move(hint));
  }

  const Field& field_;
  Reading& reading_;
  std::string name_;
};

std::optional<Value> ValueReader::read(const Node& node) {
  const auto as_value = [](auto&& read) -> std::optional<Value> {
    if (!read) return std::nullopt;
    return Value(std::move(*read));
  };
  switch (field_.type) {
    case FieldType::flag:
      if (!has_type(node, Node::Type::flag, "true or false", "write true or false, without quotes"))
        return {};
      return Value(std::get<bool>(node.value));
    case FieldType::integer:
      return as_value(integer(node));
    case FieldType::quantity:
      return as_value(quantity(node));
    case FieldType::vector:
      return vector(node);
    case FieldType::quantities:
      return list(node, &ValueReader::quantity);
    case FieldType::text:
      return as_value(text(node));
    case FieldType::texts:
      return list(node, &ValueReader::text);
    case FieldType::choice:
      return as_value(choice(node));
    case FieldType::choices:
      return list(node, &ValueReader::choice);
    case FieldType::path:
      return as_value(path(node));
    case FieldType::paths:
      return paths(node);
    case FieldType::section:
    case FieldType::table:
    case FieldType::sequence:
      break;
  }
  return std::nullopt;
}

bool ValueReader::has_type(const Node& node, Node::Type type, std::string_view wanted,
                           const std::string& hint) {
  if (node.type == type) return true;
  wrong(node, fmt::format("{} must be {}, not {}", name_, wanted, kind_of_value(node)), hint);
  return false;
}

bool ValueReader::in_range(double value, const Node& node) {
  const Range& range = field_.range;
  if (range.contains(value)) return true;
  const bool low = (range.above && value <= *range.above) || (range.at_least && value < *range.at_least);
  const bool sign = low && value < 0 && (range.above == 0.0 || range.at_least == 0.0);
  const bool zero = low && value == 0 && range.above == 0.0;
  const std::string_view what = sign   ? "cannot be negative"
                                : zero ? "cannot be zero"
                                : low  ? "is too small"
                                       : "is too large";
  wrong(node, fmt::format("{} {}", name_, what),
        fmt::format("give a value {}", to_text(range, field_.dimension)));
  return false;
}

std::optional<double> ValueReader::quantity(const Node& node) {
  const Dimension dimension = field_.dimension;
  const bool bare = dimension == Dimension::none;
  double value = 0.0;
  if (node.type == Node::Type::text) {
    const auto parsed = parse_quantity(std::get<std::string>(node.value), dimension);
    if (const auto* problem = std::get_if<std::string>(&parsed)) {
      wrong(node, fmt::format("{}: {}", name_, *problem),
            bare ? std::string("write for example 0.5")
                 : fmt::format("write for example \"5 {}\"", si_unit_of(dimension)));
      return std::nullopt;
    }
    value = std::get<double>(parsed);
  } else if (node.type == Node::Type::integer || node.type == Node::Type::number) {
    value = node.type == Node::Type::integer ? static_cast<double>(std::get<std::int64_t>(node.value))
                                             : std::get<double>(node.value);
    if (!bare) {
      wrong(node,
            fmt::format("{} needs a unit: {} is given in {}", name_, name_of(dimension), units_of(dimension)),
            fmt::format("write for example \"{} {}\"", value, si_unit_of(dimension)));
      return std::nullopt;
    }
    if (!std::isfinite(value)) {
      wrong(node, fmt::format("{} must be a finite number", name_), {});
      return std::nullopt;
    }
  } else {
    const std::string wanted = bare ? "a number" : fmt::format("a {} with its unit", name_of(dimension));
    has_type(node, Node::Type::text, wanted,
             bare ? std::string() : fmt::format("write for example \"5 {}\"", si_unit_of(dimension)));
    return std::nullopt;
  }
  return in_range(value, node) ? std::optional(value) : std::nullopt;
}

std::optional<std::int64_t> ValueReader::integer(const Node& node) {
  if (!has_type(node, Node::Type::integer, "a whole number", "write for example 3, without point and quotes"))
    return {};
  const auto value = std::get<std::int64_t>(node.value);
  return in_range(static_cast<double>(value), node) ? std::optional(value) : std::nullopt;
}

std::optional<std::string> ValueReader::text(const Node& node) {
  if (!has_type(node, Node::Type::text, "a text", "put it in quotes")) return {};
  return std::get<std::string>(node.value);
}

std::optional<std::string> ValueReader::choice(const Node& node) {
  const std::optional<std::string> word = text(node);
  if (!word) return word;
  for (const std::string& known : field_.choices)
    if (known == *word) return word;
  wrong(node, fmt::format("{} cannot be \"{}\"", name_, *word), known_words(*word, field_.choices));
  return std::nullopt;
}

template <class T>
std::optional<Value> ValueReader::list(const Node& node,
                                       std::optional<T> (ValueReader::*entry)(const Node&)) {
  if (!has_type(node, Node::Type::array, "a list", "put the values in [ ], with commas between them"))
    return {};
  name_ = "an entry of " + field_.key.name;
  std::vector<T> values;
  for (const Node& item : node.items)
    if (auto value = (this->*entry)(item)) values.push_back(std::move(*value));
  if (values.size() != node.items.size()) return std::nullopt;
  return Value(std::move(values));
}

std::optional<Value> ValueReader::vector(const Node& node) {
  if (node.type == Node::Type::array && node.items.size() != 3) {
    wrong(node, fmt::format("{} must have three entries, not {}", name_, node.items.size()),
          "give x, y and z");
    return std::nullopt;
  }
  const std::optional<Value> entries = list(node, &ValueReader::quantity);
  if (!entries) return std::nullopt;
  const auto& xyz = std::get<std::vector<double>>(*entries);
  return Value(Vec3(xyz[0], xyz[1], xyz[2]));
}

std::string ValueReader::place_looked_at(const fs::path& full, const Node& node) const {
  if (fs::path(std::get<std::string>(node.value)).is_absolute()) return "give a file that exists";
  const bool from_override = node.place.override_index >= 0;
  return fmt::format("looked for {}: names start from the folder {}", full.string(),
                     from_override ? "where the program is started" : "of the input file");
}

std::optional<fs::path> ValueReader::path(const Node& node) {
  const std::optional<std::string> name = text(node);
  if (!name) return std::nullopt;
  for (char c : *name) {
    if (static_cast<unsigned char>(c) >= 0x20 && c != 0x7F) continue;
    wrong(node, fmt::format("{} is not the name of a file: it holds a control character", name_), {});
    return std::nullopt;
  }
  const fs::path full = (folder_of(node) / *name).lexically_normal();
  std::error_code error;
  if (!name->empty() && fs::exists(full, error)) return full;
  wrong(node, fmt::format("{}: there is no file \"{}\"", name_, *name), place_looked_at(full, node));
  return std::nullopt;
}

/// Adds the file, or those that match the pattern, that one entry names.
void ValueReader::add_files(const Node& node, std::vector<fs::path>& files) {
  const bool pattern = node.type == Node::Type::text && is_pattern(std::get<std::string>(node.value));
  const fs::path folder = folder_of(node);
  std::error_code error;
  if (!pattern || fs::exists(folder / std::get<std::string>(node.value), error)) {
    if (auto file = path(node)) files.push_back(std::move(*file));
    return;
  }
  std::string escaped;  // a * in the name of the folder is just a *
  for (char c : folder.string()) {
    if (std::string_view("*?[]\\").find(c) != std::string_view::npos) escaped += '\\';
    escaped += c;
  }
  const std::string& name = std::get<std::string>(node.value);
  const std::vector<fs::path> found = expand_pattern(fs::path(escaped) / name);
  if (found.empty())
    wrong(node, fmt::format("{}: no file matches \"{}\"", name_, name), place_looked_at(folder / name, node));
  for (const fs::path& file : found) files.push_back(file.lexically_normal());
}

std::optional<Value> ValueReader::paths(const Node& node) {
  const std::size_t errors_before = reading_.errors.size();
  std::vector<fs::path> files;
  if (node.type == Node::Type::text) {
    add_files(node, files);
  } else {
    if (!has_type(node, Node::Type::array, "a file or a list of files", "for example \"stones/*.obj\""))
      return {};
    name_ = "an entry of " + field_.key.name;
    for (const Node& item : node.items) add_files(item, files);
    if (node.items.empty())
      wrong(node, fmt::format("{} names no file", field_.key.name), "for example \"stones/*.obj\"");
  }
  if (reading_.errors.size() > errors_before) return std::nullopt;
  return Value(std::move(files));
}

}  // namespace

std::optional<Value> read_value(const Field& field, const Node& node, Reading& reading) {
  return ValueReader(field, reading).read(node);
}

std::string_view kind_of_value(const Node& node) {
  switch (node.type) {
    case Node::Type::flag:
      return std::get<bool>(node.value) ? "true" : "false";
    case Node::Type::integer:
      return "a whole number";
    case Node::Type::number:
      return "a number";
    case Node::Type::text:
      return "a text";
    case Node::Type::date:
      return "a date or time of day";
    case Node::Type::array:
      return "a list";
    case Node::Type::table:
      return "a table";
  }
  return {};
}

}  // namespace trackbed
