#include "io/read.h"

#include <fmt/format.h>

#include <algorithm>

#include "io/diagnostics.h"
#include "io/files.h"
#include "io/nearest.h"
#include "io/overrides.h"
#include "io/values.h"

namespace trackbed {
namespace fs = std::filesystem;
namespace {

/// Reads one table; tables inside it have readers of their own.
class Reader : public Fields {
 public:
  /// `path` is dotted, `title` what messages call the table.
  Reader(const Node& table, std::string path, std::string title, Reading& reading)
      : table_(table),
        path_(std::move(path)),
        title_(std::move(title)),
        reading_(reading),
        errors_before_(reading.errors.size()) {}

  void check(bool ok, std::string_view key, std::string_view problem, std::string_view hint) override {
    if (ok || reading_.errors.size() > errors_before_) return;
    const Node* node = table_.find(key);
    reading_.errors.add(node ? node->place : table_.place, std::string(problem), std::string(hint));
  }
  std::string here() const override { return path_; }

  /// To be called when all fields are declared: a key that nobody asked for is an error.
  void refuse_unknown_keys() const;

 protected:
  std::optional<Value> visit(const Field& field, const std::optional<Value>& current) override;
  void visit(const Field& field, Elements& elements) override;

 private:
  const Node* look_up(const Field& field);
  void read_section(const Field& field, const Node* node, Elements& elements);
  void read_elements(const Field& field, const Node& node, Elements& elements);
  std::optional<std::string> read_kind(const Node& node, const std::string& title, const Elements& elements);
  template <class Declare>
  void read_inside(const Node& node, const std::string& path, const std::string& title,
                   const Elements& elements, Declare&& declare_inside);
  std::string inside(const std::string& key) const { return path_.empty() ? key : path_ + "." + key; }

  const Node& table_;
  std::string path_, title_;
  Reading& reading_;
  std::size_t errors_before_;
  std::vector<std::string> declared_;
};

void Reader::refuse_unknown_keys() const {
  for (const Node& item : table_.items) {
    if (std::find(declared_.begin(), declared_.end(), item.key) != declared_.end()) continue;
    reading_.errors.add(item.key_place, fmt::format("{} is not a key of {}", item.key, title_),
                        known_words(item.key, declared_));
  }
}

const Node* Reader::look_up(const Field& field) {
  declared_.push_back(field.key.name);
  const Node* node = table_.find(field.key.name);
  if (!node && field.key.required)
    reading_.errors.add(table_.place, fmt::format("{} is missing in {}", field.key.name, title_),
                        fmt::format("add {} ({}): {}", field.key.name, type_of(field), field.meaning));
  return node;
}

std::optional<Value> Reader::visit(const Field& field, const std::optional<Value>&) {
  const Node* node = look_up(field);
  if (!node) return std::nullopt;
  return read_value(field, *node, reading_);
}

void Reader::visit(const Field& field, Elements& elements) {
  const Node* node = look_up(field);
  const bool list = field.type == FieldType::sequence;
  const bool right_type = !node || node->type == (list ? Node::Type::array : Node::Type::table);
  if (!right_type) {
    const std::string& key = field.key.name;
    reading_.errors.add(node->place,
                        fmt::format("{} must be {}, not {}", key, list ? "a list of tables" : "a table",
                                    kind_of_value(*node)),
                        list ? fmt::format("begin each element with a line [[{}]]", inside(key))
                             : fmt::format("begin it with a line [{}]", inside(key)));
  } else if (field.type == FieldType::section) {
    read_section(field, node, elements);
  } else if (node) {
    read_elements(field, *node, elements);
  }
}

void Reader::read_section(const Field& field, const Node* node, Elements& elements) {
  const std::string& key = field.key.name;
  if (!node) {
    if (field.key.required || elements.kinds() || elements.size() == 0) return;
    // The defaults of its keys stand, but a required key is missed all the same.
    Node empty;
    empty.place = table_.place;
    read_inside(empty, inside(key), key, elements, [&](Reader& reader) { elements.visit(0, reader); });
    return;
  }
  const std::string old_kind = elements.size() == 1 ? elements.kind(0) : std::string();
  const std::optional<KindNames> kinds = elements.kinds();
  std::string kind = old_kind;
  if (kinds && (kind.empty() || node->find(kinds->selector))) {
    const auto chosen = read_kind(*node, key, elements);
    if (!chosen) return;
    kind = *chosen;
  }
  const std::string title = kind.empty() ? key : fmt::format("{} ({})", key, kind);
  read_inside(*node, inside(key), title, elements, [&](Reader& reader) {
    if (elements.size() == 1 && kind == old_kind)
      elements.visit(0, reader);
    else
      elements.append({}, kind, reader);
  });
}

void Reader::read_elements(const Field& field, const Node& node, Elements& elements) {
  elements.clear();
  const bool named = field.type == FieldType::table;
  for (std::size_t i = 0; i < node.items.size(); ++i) {
    const Node& item = node.items[i];
    const std::string local = fmt::format("{}.{}", field.key.name, named ? item.key : fmt::format("{}", i));
    if (item.type != Node::Type::table) {
      reading_.errors.add(item.place, fmt::format("{} must be a table, not {}", local, kind_of_value(item)),
                          named
                              ? fmt::format("begin it with a line [{}]", inside(local))
                              : fmt::format("begin each element with a line [[{}]]", inside(field.key.name)));
      continue;
    }
    const auto kind = read_kind(item, local, elements);
    if (!kind) continue;
    const std::string title = kind->empty() ? local : fmt::format("{} ({})", local, *kind);
    read_inside(item, inside(local), title, elements,
                [&](Reader& reader) { elements.append(item.key, *kind, reader); });
  }
}

/// The kind that an element asks for; empty where all are alike; nothing (and an error) when it is wrong.
std::optional<std::string> Reader::read_kind(const Node& node, const std::string& title,
                                             const Elements& elements) {
  const std::optional<KindNames> kinds = elements.kinds();
  if (!kinds) return std::string();
  const Node* chosen = node.find(kinds->selector);
  if (!chosen) {
    reading_.errors.add(node.place, fmt::format("{} is missing in {}", kinds->selector, title),
                        known_words({}, kinds->names));
    return std::nullopt;
  }
  if (chosen->type != Node::Type::text) {
    reading_.errors.add(chosen->place,
                        fmt::format("{} must be a text, not {}", kinds->selector, kind_of_value(*chosen)),
                        known_words({}, kinds->names));
    return std::nullopt;
  }
  const std::string& name = std::get<std::string>(chosen->value);
  if (std::find(kinds->names.begin(), kinds->names.end(), name) != kinds->names.end()) return name;
  reading_.errors.add(chosen->place, fmt::format("there is no {} called {}", kinds->family, name),
                      known_words(name, kinds->names));
  return std::nullopt;
}

template <class Declare>
void Reader::read_inside(const Node& node, const std::string& path, const std::string& title,
                         const Elements& elements, Declare&& declare_inside) {
  Reader reader(node, path, title, reading_);
  if (const auto kinds = elements.kinds()) reader.declared_.push_back(kinds->selector);
  declare_inside(reader);
  reader.refuse_unknown_keys();
}

std::string hint_for(const SyntaxError& error) {
  const auto says = [&](std::string_view words) { return error.problem.find(words) != std::string::npos; };
  if (says("expected a comment or whitespace") || says("expected digit, saw"))
    return "a quantity with its unit stands in quotes: \"5 kN\"";
  if (error.problem.find("cannot redefine") != std::string::npos)
    return "a key is given once; this one stands above";
  return {};
}

}  // namespace

struct Document::Parsed {
  Source source;
  fs::path file;
  Node root;
};

Document::Document(std::unique_ptr<Parsed> parsed) : parsed_(std::move(parsed)) {}
Document::~Document() = default;
Document::Document(Document&&) noexcept = default;
Document& Document::operator=(Document&&) noexcept = default;

Document::Document(const fs::path& file, const std::vector<std::string>& overrides)
    : Document(from_text(read_file(file, 10'000'000), file, overrides)) {}

Document Document::from_text(std::string text, const fs::path& name,
                             const std::vector<std::string>& overrides) {
  auto parsed = std::make_unique<Parsed>(Parsed{{name.string(), std::move(text), overrides}, name, {}});
  auto tree = parse_toml(parsed->source.text);
  Diagnostics errors(parsed->source);
  if (const SyntaxError* error = std::get_if<SyntaxError>(&tree)) {
    errors.add(error->place, error->problem, hint_for(*error));
    errors.throw_if_any();
  }
  parsed->root = std::move(std::get<Node>(tree));
  parsed->root.place = {};  // the whole file is no place to point at
  apply_overrides(parsed->root, parsed->source, errors);
  errors.throw_if_any();
  return Document(std::move(parsed));
}

void Document::read_with(const std::function<void(Fields&)>& declare_all) const {
  Diagnostics errors(parsed_->source);
  Reading reading{parsed_->file.parent_path(), errors};
  Reader reader(parsed_->root, {}, "this file", reading);
  declare_all(reader);
  reader.refuse_unknown_keys();
  errors.throw_if_any();
}

void Document::fail(std::string_view dotted_key, std::string_view problem, std::string_view hint) const {
  Diagnostics errors(parsed_->source);
  Node* node = &parsed_->root;
  for (std::string_view part : parts_of(dotted_key)) {
    Node* next = step_into(*node, part);
    if (!next) break;  // not in the file: points at the table it would stand in
    node = next;
  }
  errors.add(node->place, std::string(problem), std::string(hint));
  errors.throw_if_any();
  std::abort();  // not reached: there is an error
}

bool Document::has(std::string_view key) const {
  return parsed_->root.find(key) != nullptr;
}

const fs::path& Document::file() const {
  return parsed_->file;
}

}  // namespace trackbed
