#include "io/overrides.h"

#include <fmt/format.h>

#include <charconv>

#include "io/nearest.h"

namespace trackbed {
namespace {

std::string_view trimmed(std::string_view text) {
  const std::size_t first = text.find_first_not_of(" \t");
  if (first == std::string_view::npos) return {};
  return text.substr(first, text.find_last_not_of(" \t") - first + 1);
}

/// The value of "key=value": TOML where it is that, else a bare word. Nothing (and an error) when it looks
/// like TOML but is broken.
std::optional<Node> read_override_value(std::string_view text, const Place& place, Diagnostics& errors) {
  const bool one_line = text.find('\n') == std::string_view::npos;
  if (one_line) {
    auto parsed = parse_toml(fmt::format("v = {}", text));
    if (const Node* table = std::get_if<Node>(&parsed); table && table->items.size() == 1)
      return table->items[0];
    const bool meant_as_toml =
        !text.empty() && std::string_view("\"'[{").find(text[0]) != std::string_view::npos;
    if (meant_as_toml || text.empty()) {
      errors.add(place,
                 text.empty()
                     ? "there is no value after ="
                     : fmt::format("the value is not TOML: {}", std::get<SyntaxError>(parsed).problem),
                 "for example --set seed=3 or --set 'time=\"2 s\"'");
      return std::nullopt;
    }
  }
  if (auto parsed = parse_toml(text); std::holds_alternative<SyntaxError>(parsed)) {
    const SyntaxError& error = std::get<SyntaxError>(parsed);
    if (error.problem.starts_with("this is not UTF-8")) {
      errors.add(place, "the value is not UTF-8 text");
      return std::nullopt;
    }
  }
  Node word;
  word.type = Node::Type::text;
  word.value = std::string(text);
  return word;
}

void set_places(Node& node, const Place& place) {
  node.key_place = node.place = place;
  for (Node& item : node.items) set_places(item, place);
}

/// What an element of a list is called: its name, or else its kind, as stages are; nothing when it has
/// neither.
std::optional<std::string> name_of(const Node& element) {
  for (const char* key : {"name", "kind"})
    if (const Node* name = element.find(key); name && name->type == Node::Type::text)
      return std::get<std::string>(name->value);
  return std::nullopt;
}

/// Says why a list has no such element.
void add_no_element(const Node& list, std::string_view part, const Place& place, Diagnostics& errors) {
  std::vector<std::string> names;
  for (const Node& item : list.items)
    if (const auto name = name_of(item)) names.push_back(*name);
  const std::size_t n = list.items.size();
  const std::string problem = fmt::format("{} has no element {}", list.key, part);
  const std::string by_index =
      n == 0 ? "the list is empty" : fmt::format("elements are counted from 0 to {}", n - 1);
  errors.add(place, problem,
             names.empty() ? by_index : fmt::format("{}; {}", by_index, known_words(part, names)));
}

/// The node that a key leads to, made where it is missing; null (and an error) when it leads nowhere.
Node* make_way(Node& root, std::string_view key, const Place& place, Diagnostics& errors) {
  Node* node = &root;
  for (std::string_view part : parts_of(key)) {
    if (part.empty()) {
      errors.add(place, fmt::format("\"{}\" is not a key", key), "for example --set stages.2.time=\"2 s\"");
      return nullptr;
    }
    if (Node* next = step_into(*node, part)) {
      node = next;
    } else if (node->type == Node::Type::table) {
      Node made;
      made.key = std::string(part);
      set_places(made, place);
      node->items.push_back(std::move(made));
      node = &node->items.back();
    } else if (node->type == Node::Type::array) {
      add_no_element(*node, part, place, errors);
      return nullptr;
    } else {
      errors.add(place, fmt::format("{} is not a table: it has no {}", node->key, part));
      return nullptr;
    }
  }
  return node;
}

}  // namespace

std::vector<std::string_view> parts_of(std::string_view dotted_key) {
  std::vector<std::string_view> parts;
  for (std::size_t dot = dotted_key.find('.'); dot != std::string_view::npos; dot = dotted_key.find('.')) {
    parts.push_back(trimmed(dotted_key.substr(0, dot)));
    dotted_key.remove_prefix(dot + 1);
  }
  parts.push_back(trimmed(dotted_key));
  return parts;
}

Node* step_into(Node& node, std::string_view part) {
  if (node.type == Node::Type::table) return node.find(part);
  if (node.type != Node::Type::array) return nullptr;
  std::size_t index = 0;
  const auto [end, error] = std::from_chars(part.data(), part.data() + part.size(), index);
  if (error == std::errc{} && end == part.data() + part.size())
    return index < node.items.size() ? &node.items[index] : nullptr;
  for (Node& item : node.items)
    if (name_of(item) == part) return &item;
  return nullptr;
}

void apply_overrides(Node& root, const Source& source, Diagnostics& errors) {
  for (std::size_t i = 0; i < source.overrides.size(); ++i) {
    const std::string_view text = source.overrides[i];
    Place place;
    place.override_index = static_cast<int>(i);
    const std::size_t equals = text.find('=');
    if (equals == std::string_view::npos) {
      errors.add(place, "there is no =", "write --set key=value, for example --set seed=3");
      continue;
    }
    std::optional<Node> value = read_override_value(trimmed(text.substr(equals + 1)), place, errors);
    Node* target = value ? make_way(root, trimmed(text.substr(0, equals)), place, errors) : nullptr;
    if (!target) continue;
    value->key = target->key;
    set_places(*value, place);
    *target = std::move(*value);
  }
}

}  // namespace trackbed
