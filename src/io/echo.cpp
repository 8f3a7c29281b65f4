#include "io/echo.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <map>
#include <string>
#include <vector>

namespace trackbed {
namespace {

using nlohmann::ordered_json;

/// A quantity as it could stand in the file.
ordered_json to_json(double value, Dimension dimension) {
  if (dimension == Dimension::none) return value;
  return to_text(value, dimension);
}

ordered_json to_json(const Value& value, Dimension dimension) {
  const auto convert = [&](const auto& v) -> ordered_json {
    using T = std::decay_t<decltype(v)>;
    if constexpr (std::is_same_v<T, double>) {
      return to_json(v, dimension);
    } else if constexpr (std::is_same_v<T, Vec3> || std::is_same_v<T, std::vector<double>>) {
      ordered_json list = ordered_json::array();
      for (double entry : v) list.push_back(to_json(entry, dimension));
      return list;
    } else if constexpr (std::is_same_v<T, std::filesystem::path>) {
      return v.string();
    } else if constexpr (std::is_same_v<T, std::vector<std::filesystem::path>>) {
      ordered_json list = ordered_json::array();
      for (const auto& path : v) list.push_back(path.string());
      return list;
    } else {
      return v;
    }
  };
  return std::visit(convert, value);
}

class Echoer : public Fields {
 public:
  ordered_json json = ordered_json::object();
  void check(bool, std::string_view, std::string_view, std::string_view) override {}

 protected:
  std::optional<Value> visit(const Field& field, const std::optional<Value>& current) override {
    if (current) json[field.key.name] = to_json(*current, field.dimension);
    return std::nullopt;
  }
  void visit(const Field& field, Elements& elements) override {
    ordered_json all = field.type == FieldType::sequence ? ordered_json::array() : ordered_json::object();
    for (std::size_t i = 0; i < elements.size(); ++i) {
      Echoer inside;
      if (const auto kinds = elements.kinds()) inside.json[kinds->selector] = elements.kind(i);
      elements.visit(i, inside);
      if (field.type == FieldType::sequence)
        all.push_back(std::move(inside.json));
      else if (field.type == FieldType::table)
        all[elements.name(i)] = std::move(inside.json);
      else
        all = std::move(inside.json);
    }
    if (elements.size() > 0 || field.type != FieldType::section) json[field.key.name] = std::move(all);
  }
};

void flatten(const ordered_json& json, const std::string& path, std::map<std::string, std::string>& all) {
  if (json.is_object() || (json.is_array() && !json.empty() && json[0].is_object())) {
    std::size_t k = 0;
    for (const auto& [key, value] : json.items()) {
      std::string part = json.is_array() ? std::to_string(k) : key;
      if (json.is_array() && value.contains("name")) part = value["name"].get<std::string>();
      flatten(value, path.empty() ? part : path + "." + part, all);
      ++k;
    }
    return;
  }
  all[path] = json.is_string() ? json.get<std::string>() : json.dump();
}

}  // namespace

ordered_json echo_with(const std::function<void(Fields&)>& declare_all) {
  Echoer echoer;
  declare_all(echoer);
  return std::move(echoer.json);
}

std::string difference(const ordered_json& before, const ordered_json& after) {
  std::map<std::string, std::string> old_values, new_values;
  flatten(before, "", old_values);
  flatten(after, "", new_values);
  std::vector<std::string> changes;
  for (const auto& [key, value] : new_values) {
    const auto old = old_values.find(key);
    if (old == old_values.end())
      changes.push_back(fmt::format("{}: new", key));
    else if (old->second != value)
      changes.push_back(fmt::format("{}: {} -> {}", key, old->second, value));
  }
  for (const auto& [key, value] : old_values)
    if (!new_values.contains(key)) changes.push_back(fmt::format("{}: gone", key));
  constexpr std::size_t most = 3;
  const std::size_t all = changes.size();
  if (all > most) changes.resize(most);
  return fmt::format("{}{}", fmt::join(changes, ", "),
                     all > most ? fmt::format(" and {} more", all - most) : "");
}

}  // namespace trackbed
