#include "io/echo.h"

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

}  // namespace

ordered_json echo_with(const std::function<void(Fields&)>& declare_all) {
  Echoer echoer;
  declare_all(echoer);
  return std::move(echoer.json);
}

}  // namespace trackbed
