// Every key that is described can be misspelt, and is then named; every key is read and comes back in the
// echo.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <map>
#include <set>

#include "base/error.h"
#include "io/describe.h"
#include "io/echo.h"
#include "io/files.h"
#include "io/read.h"
#include "io/toml.h"
#include "lab/case.h"

namespace trackbed {
namespace {

using Json = nlohmann::ordered_json;
namespace fs = std::filesystem;

const fs::path folder = fs::path(TRACKBED_ROOT) / "tests/input/every_key";
const std::map<std::string, std::string> tables{
    {"wall", "walls"}, {"body", "bodies"}, {"region", "regions"}, {"stage", "stages"}};

/// A key, with the dotted paths of its tables in a case: "stages.2" and "embedment".
struct DescribedKey {
  std::vector<std::string> places;
  std::string name;
  bool required = false;
};

std::string joined(const std::string& table, const std::string& key) {
  return table.empty() ? key : table + "." + key;
}

/// The value at a dotted path; null where there is none.
Json at(const Json& json, const std::string& path) {
  const Json* node = &json;
  for (std::size_t from = 0; from <= path.size();) {
    const std::size_t dot = std::min(path.find('.', from), path.size());
    const std::string part = path.substr(from, dot - from);
    if (node->is_array() && std::stoul(part) < node->size())
      node = &(*node)[std::stoul(part)];
    else if (node->is_object() && node->contains(part))
      node = &(*node)[part];
    else
      return nullptr;
    from = dot + 1;
  }
  return *node;
}

/// The paths of all tables of a kind.
std::vector<std::string> places_of(const Json& input, const std::string& table, const std::string& kind) {
  std::vector<std::string> places;
  for (const auto& [key, element] : input[table].items())
    if (element["kind"] == kind) places.push_back(table + "." + key);
  return places;
}

/// All keys but those of tables, and where they stand in this input.
std::vector<DescribedKey> described_keys(const Json& input) {
  std::vector<DescribedKey> keys;
  const auto add = [&](const Page::Row& row, const std::vector<std::string>& places) {
    std::string path = row.key;
    if (const auto name = path.find("NAME"); name != std::string::npos) {
      const std::string table = path.substr(0, name - 1);
      path.replace(name, 4, at(input, table).items().begin().key());
    }
    const auto dot = path.rfind('.');
    const std::string inside = dot == std::string::npos ? "" : path.substr(0, dot);
    DescribedKey key{{}, dot == std::string::npos ? path : path.substr(dot + 1), row.fallback == "required"};
    for (const std::string& place : places)
      key.places.push_back(inside.empty() || place.empty() ? place + inside : joined(place, inside));
    const Json value = at(input, joined(key.places.at(0), key.name));
    const bool is_table = value.is_object() || (value.is_array() && !value.empty() && value[0].is_object());
    if (!is_table) keys.push_back(std::move(key));
  };
  const Description description = describe<CaseInput>("case", "");
  for (const Page::Row& row : description.top.rows) add(row, {""});
  for (const auto& [family, pages] : description.families)
    for (const Page& page : pages)
      for (const Page::Row& row : page.rows) add(row, places_of(input, tables.at(family), page.name));
  return keys;
}

Json echo_of(const fs::path& file) {
  return echo(read_input<CaseInput>(file));
}

/// What hurried fingers make of a word: neighbours swapped, a letter doubled, a letter left out.
std::set<std::string> misspelt(const std::string& word) {
  std::set<std::string> words;
  for (std::size_t k = 0; k < word.size(); ++k) {
    std::string other = word;
    if (k + 1 < word.size()) std::swap(other[k], other[k + 1]);
    words.insert(other);
    words.insert(word.substr(0, k) + word[k] + word.substr(k));
    if (word.size() > 3) words.insert(word.substr(0, k) + word.substr(k + 1));
  }
  words.erase(word);
  return words;
}

TEST(EveryKey, MisspeltIsRefusedAndNamed) {
  const fs::path file = folder / "all.toml";
  const std::vector<DescribedKey> keys = described_keys(echo_of(file));
  EXPECT_GT(keys.size(), 80u);
  const std::string text = read_file(file);
  for (const DescribedKey& key : keys) {
    for (const std::string& word : misspelt(key.name)) {
      CaseInput input;
      std::string message;
      try {
        Document::from_text(text, file, {joined(key.places[0], word) + "=1"}).read(input);
      } catch (const InputError& error) {
        message = error.what();
      }
      EXPECT_NE(message.find(fmt::format("{} is not a key of", word)), std::string::npos) << message;
      EXPECT_NE(message.find(fmt::format("did you mean {}?", key.name)), std::string::npos)
          << key.name << ": " << message;
    }
  }
}

/// What stands in the file against what came back.
void expect_echoed(const Node& node, const Json& echoed, const std::string& path) {
  switch (node.type) {
    case Node::Type::table:
    case Node::Type::array:
      ASSERT_EQ(node.items.size(), node.type == Node::Type::array ? echoed.size() : node.items.size())
          << path;
      for (std::size_t k = 0; k < node.items.size(); ++k) {
        const std::string& key = node.items[k].key;
        const bool is_list = node.type == Node::Type::array;
        ASSERT_TRUE(is_list || echoed.contains(key)) << joined(path, key);
        expect_echoed(node.items[k], is_list ? echoed[k] : echoed[key], joined(path, key));
      }
      break;
    case Node::Type::flag:
      EXPECT_EQ(echoed, std::get<bool>(node.value)) << path;
      break;
    case Node::Type::integer:
      EXPECT_EQ(echoed, std::get<std::int64_t>(node.value)) << path;
      break;
    case Node::Type::number:
      EXPECT_EQ(echoed, std::get<double>(node.value)) << path;
      break;
    default: {
      const std::string& text = std::get<std::string>(node.value);
      const bool is_file = text.starts_with("../");
      EXPECT_EQ(echoed, is_file ? (folder / text).lexically_normal().string() : text) << path;
    }
  }
}

TEST(EveryKey, ComesBackAsItWasGiven) {
  for (const char* name : {"all.toml", "least.toml"}) {
    const auto parsed = parse_toml(read_file(folder / name));
    ASSERT_TRUE(std::holds_alternative<Node>(parsed));
    expect_echoed(std::get<Node>(parsed), echo_of(folder / name), "");
  }
}

TEST(EveryKey, IsGivenAnotherValueThanItsDefault) {
  const Json all = echo_of(folder / "all.toml"), least = echo_of(folder / "least.toml");
  for (const DescribedKey& key : described_keys(all)) {
    const bool changed = std::ranges::any_of(key.places, [&](const std::string& place) {
      const std::string path = joined(place, key.name);
      const Json value = at(all, path);
      return !value.is_null() && (key.required || value != at(least, path));
    });
    EXPECT_TRUE(changed) << joined(key.places[0], key.name) << " is not in all.toml";
  }
}

}  // namespace
}  // namespace trackbed
