// The only place that sees toml++. Compiled with NDEBUG (src/dependencies.cmake): its assertions abort on
// some broken texts that its parser then refuses properly.
#include "io/toml.h"

#include <fmt/format.h>
#include <toml++/toml.h>

#include <algorithm>
#include <optional>

namespace trackbed {
namespace {

struct Position {
  int line = 1, column = 1;
  void advance(char c) {
    if (c == '\n') {
      ++line;
      column = 1;
    } else if ((static_cast<unsigned char>(c) & 0xC0u) != 0x80u) {  // not the rest of a longer character
      ++column;
    }
  }
};

/// Length of the UTF-8 character at the start of `text`, 0 if it is none (Unicode 15, table 3-7).
std::size_t character_length(std::string_view text) {
  const auto byte = [&](std::size_t i) { return static_cast<unsigned char>(i < text.size() ? text[i] : 0); };
  const auto follows = [&](std::size_t i) { return (byte(i) & 0xC0u) == 0x80u; };
  const unsigned first = byte(0);
  if (first < 0x80) return 1;
  if (first >= 0xC2 && first <= 0xDF) return follows(1) ? 2 : 0;
  if (first >= 0xE0 && first <= 0xEF) {
    const bool overlong = first == 0xE0 && byte(1) < 0xA0;
    const bool surrogate = first == 0xED && byte(1) >= 0xA0;
    return follows(1) && follows(2) && !overlong && !surrogate ? 3 : 0;
  }
  if (first >= 0xF0 && first <= 0xF4) {
    const bool overlong = first == 0xF0 && byte(1) < 0x90;
    const bool beyond = first == 0xF4 && byte(1) >= 0x90;
    return follows(1) && follows(2) && follows(3) && !overlong && !beyond ? 4 : 0;
  }
  return 0;
}

std::optional<SyntaxError> find_bad_character(std::string_view text) {
  Position at;
  while (!text.empty()) {
    const std::size_t length = character_length(text);
    if (length == 0)
      return SyntaxError{{at.line, at.column},
                         "this is not UTF-8 text: save the file with the encoding UTF-8"};
    at.advance(text[0]);
    text.remove_prefix(length);
  }
  return std::nullopt;
}

/// A key of very many parts (a.a.a. ...) would nest tables until the stack overflows.
std::optional<SyntaxError> find_deep_key(std::string_view text) {
  constexpr int deepest = 100;
  Position at;
  int dots = 0;
  bool part = false;   // a part of a key has begun
  bool blank = false;  // blanks came after it: only a dot goes on
  for (char c : text) {
    if (std::string_view("=[]{},#\n").find(c) != std::string_view::npos) {
      dots = 0;
      part = blank = false;
    } else if (c == '.') {
      dots = part ? dots + 1 : 0;
      part = blank = false;
    } else if (c == ' ' || c == '\t') {
      blank = part;
    } else {
      if (blank) dots = 0;
      part = true;
      blank = false;
    }
    if (dots > deepest)
      return SyntaxError{{at.line, at.column}, fmt::format("a key of more than {} parts", deepest)};
    at.advance(c);
  }
  return std::nullopt;
}

Place place_of(const toml::source_region& region) {
  Place place{static_cast<int>(region.begin.line), static_cast<int>(region.begin.column)};
  const bool one_line = region.end.line == region.begin.line && region.end.column > region.begin.column;
  if (one_line) place.length = static_cast<int>(region.end.column - region.begin.column);
  return place;
}

Node convert(const toml::node& source) {
  Node node;
  node.place = place_of(source.source());
  if (const auto* table = source.as_table()) {
    node.type = Node::Type::table;
    for (const auto& [key, value] : *table) {
      Node item = convert(value);
      item.key = std::string(key.str());
      item.key_place = place_of(key.source());
      node.items.push_back(std::move(item));
    }
  } else if (const auto* array = source.as_array()) {
    node.type = Node::Type::array;
    for (const toml::node& value : *array) node.items.push_back(convert(value));
  } else if (const auto* flag = source.as_boolean()) {
    node.type = Node::Type::flag;
    node.value = flag->get();
  } else if (const auto* integer = source.as_integer()) {
    node.type = Node::Type::integer;
    node.value = integer->get();
  } else if (const auto* number = source.as_floating_point()) {
    node.type = Node::Type::number;
    node.value = number->get();
  } else if (const auto* text = source.as_string()) {
    node.type = Node::Type::text;
    node.value = text->get();
  } else {
    node.type = Node::Type::date;
  }
  return node;
}

/// toml++ says "Error while parsing key-value pair: cannot redefine ..."; only the end of it helps.
std::string plain_words(std::string_view description) {
  constexpr std::string_view opening = "Error while parsing ";
  std::string text(description);
  if (description.starts_with(opening)) text = "in this " + std::string(description.substr(opening.size()));
  return text;
}

}  // namespace

Node* Node::find(std::string_view name) {
  const auto found =
      std::find_if(items.begin(), items.end(), [&](const Node& item) { return item.key == name; });
  return type == Type::table && found != items.end() ? &*found : nullptr;
}

const Node* Node::find(std::string_view name) const {
  return const_cast<Node*>(this)->find(name);
}

std::variant<Node, SyntaxError> parse_toml(std::string_view text) {
  if (auto error = find_bad_character(text)) return *error;
  if (auto error = find_deep_key(text)) return *error;
  try {
    return convert(toml::parse(text));
  } catch (const toml::parse_error& error) {
    return SyntaxError{place_of(error.source()), plain_words(error.description())};
  }
}

}  // namespace trackbed
