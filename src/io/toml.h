// A TOML text as a tree in which every key and value knows its place.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

namespace trackbed {

/// Where something stands: in the file, or in an override of the command line.
struct Place {
  int line = 0;             // from 1; 0: nowhere in particular
  int column = 0;           // from 1, in characters
  int length = 1;           // [characters], on this line
  int override_index = -1;  // of the override it came from; -1: the file
};

/// A key and its value. Tables and arrays hold theirs in `items`.
struct Node {
  enum class Type { flag, integer, number, text, date, array, table };
  Type type = Type::table;
  std::variant<bool, std::int64_t, double, std::string> value = false;  // of the first four types
  std::string key;
  Place key_place;
  Place place;  // of the value
  std::vector<Node> items;

  Node* find(std::string_view name);  ///< the item with this key
  const Node* find(std::string_view name) const;
};

/// What is wrong with a text that is not TOML.
struct SyntaxError {
  Place place;
  std::string problem;
};

/// Never throws for any text, only for want of memory.
std::variant<Node, SyntaxError> parse_toml(std::string_view text);

}  // namespace trackbed
