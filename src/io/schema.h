// How an input is declared: once. The one function
//
//   struct SettleInput {
//     double unbalanced_ratio = 1e-3;  // default: the value that stands here
//     double time_limit = 0;           // [s]
//     std::optional<double> friction;  // may be absent
//   };
//   void declare(Fields& f, SettleInput& in) {
//     f.number("unbalanced_ratio", in.unbalanced_ratio, {.above = 0, .at_most = 1}, "stop below this ratio");
//     f.quantity(required("time_limit"), in.time_limit, Dimension::time, {.above = 0}, "fail after this
//     time"); f.number("friction", in.friction, {.at_least = 0, .at_most = 10}, "of all contacts during this
//     stage");
//   }
//
// reads and checks the struct (io/read.h), describes it to the user (io/describe.h) and writes it back with
// all defaults filled in (io/echo.h). All three are visitors: children of Fields.
#pragma once

#include <concepts>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <limits>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <variant>
#include <vector>

#include "base/units.h"
#include "base/vec.h"

namespace trackbed {

/// Name of a key in the file. A key that is not `required` keeps the default that its struct holds.
struct Key {
  // Implicit, so that a declaration can say just "friction".
  Key(const char* key_name) : name(key_name) {}  // NOLINT(google-explicit-constructor)
  Key(std::string_view key_name, bool is_required) : name(key_name), required(is_required) {}
  std::string name;
  bool required = false;
};

/// A key that must be in the file.
inline Key required(std::string_view name) {
  return {name, true};
}

/// Allowed values, in SI. For vectors and lists: of each entry.
struct Range {
  std::optional<double> above = {}, at_least = {};  // > and >=
  std::optional<double> below = {}, at_most = {};   // < and <=

  bool contains(double value) const;
};

/// "from 0 to 10", "above 0 s"; empty when everything is allowed.
std::string to_text(const Range& range, Dimension dimension);

enum class FieldType {
  flag,        // true or false
  integer,     //
  quantity,    // a number with the unit of its dimension
  vector,      // three quantities
  quantities,  // a list of quantities
  text,        // any text
  texts,       //
  choice,      // one of the words in `choices`
  choices,     //
  path,        // a file or folder that exists
  paths,       // such files; patterns like "stones/*.obj" are expanded
  section,     // a table with keys of its own
  table,       // tables by name: [materials.ballast]
  sequence,    // an array of tables: [[stages]]
};

/// All that is said of one key, apart from its value.
struct Field {
  Key key;
  FieldType type = FieldType::text;
  std::string meaning;
  Dimension dimension = Dimension::none;
  Range range = {};
  std::vector<std::string> choices = {};
  bool optional = false;  // has no default: may be absent
};

/// What is written there: "time [s]", "one of: linear, hertz", "whole number".
std::string type_of(const Field& field);

/// Value of a field that is not a table, in SI.
using Value = std::variant<bool, std::int64_t, double, Vec3, std::string, std::filesystem::path,
                           std::vector<double>, std::vector<std::string>, std::vector<std::filesystem::path>>;

class Fields;

/// One row of a registry: an input struct (a child of Base) that is chosen by name.
template <class Base>
struct Kind {
  std::string name;
  std::string meaning;  // one line
  std::function<std::shared_ptr<Base>()> make;
  std::function<void(Fields&, Base&)> declare_input;
};

/// A registry: what `kind = "..."` may say. Must live as long as the inputs made from it.
template <class Base>
struct Kinds {
  std::string family;             // "stage": heads the page of the documentation, used in messages
  std::vector<Kind<Base>> rows;   //
  std::string selector = "kind";  // the key that chooses

  const Kind<Base>* find(std::string_view name) const {
    for (const Kind<Base>& row : rows)
      if (row.name == name) return &row;
    return nullptr;
  }
};

/// An input chosen by its kind.
template <class Base>
struct OneOf {
  std::string kind;
  std::shared_ptr<Base> input;
};

/// The row of an input struct that has its own `declare`: kind_of<StageInput, SettleInput>("settle", "...").
template <class Base, std::derived_from<Base> Input>
Kind<Base> kind_of(std::string name, std::string meaning) {
  return {std::move(name), std::move(meaning), [] { return std::make_shared<Input>(); },
          [](Fields& f, Base& in) { declare(f, static_cast<Input&>(in)); }};
}

/// A registry without its types, for messages and documentation.
struct KindNames {
  std::string family, selector;
  std::vector<std::string> names, meanings;
};

/// The tables inside a section, table or sequence, whatever their type.
class Elements {
 public:
  virtual ~Elements() = default;
  virtual std::size_t size() const = 0;
  virtual std::string name(std::size_t i) const = 0;   ///< in a table of names; else empty
  virtual std::string kind(std::size_t i) const = 0;   ///< where there are kinds; else empty
  virtual std::optional<KindNames> kinds() const = 0;  ///< nothing: all elements are alike
  virtual void visit(std::size_t i, Fields& f) = 0;    ///< declares element i to f
  virtual void clear() = 0;                            ///< forgets the default elements
  virtual void append(const std::string& name, const std::string& kind, Fields& f) = 0;  ///< makes, declares
};

template <class T, class V>
concept OrOptional = std::same_as<T, V> || std::same_as<T, std::optional<V>>;

/// What a declaration talks to. Each function names a key, the member that holds it, and what it means.
class Fields {
 public:
  virtual ~Fields() = default;

  /// A number without unit; "40 %" is allowed.
  template <OrOptional<double> T>
  void number(Key key, T& value, const Range& range, std::string_view meaning) {
    quantity(std::move(key), value, Dimension::none, range, meaning);
  }
  template <OrOptional<double> T>
  void quantity(Key key, T& value, Dimension dimension, const Range& range, std::string_view meaning) {
    leaf<double>({std::move(key), FieldType::quantity, std::string(meaning), dimension, range}, value);
  }
  /// Three quantities: ["0 mm", "0 mm", "1 m"].
  template <OrOptional<Vec3> T>
  void vector(Key key, T& value, Dimension dimension, const Range& range, std::string_view meaning) {
    leaf<Vec3>({std::move(key), FieldType::vector, std::string(meaning), dimension, range}, value);
  }
  template <OrOptional<std::vector<double>> T>
  void quantities(Key key, T& value, Dimension dimension, const Range& range, std::string_view meaning) {
    leaf<std::vector<double>>({std::move(key), FieldType::quantities, std::string(meaning), dimension, range},
                              value);
  }
  template <std::integral T>
  void integer(Key key, T& value, const Range& range, std::string_view meaning) {
    leaf<std::int64_t>(integer_field<T>(std::move(key), range, meaning), value);
  }
  template <std::integral T>
  void integer(Key key, std::optional<T>& value, const Range& range, std::string_view meaning) {
    leaf<std::int64_t>(integer_field<T>(std::move(key), range, meaning), value);
  }
  template <OrOptional<bool> T>
  void flag(Key key, T& value, std::string_view meaning) {
    leaf<bool>({std::move(key), FieldType::flag, std::string(meaning)}, value);
  }
  template <OrOptional<std::string> T>
  void text(Key key, T& value, std::string_view meaning) {
    leaf<std::string>({std::move(key), FieldType::text, std::string(meaning)}, value);
  }
  template <OrOptional<std::vector<std::string>> T>
  void texts(Key key, T& value, std::string_view meaning) {
    leaf<std::vector<std::string>>({std::move(key), FieldType::texts, std::string(meaning)}, value);
  }
  /// One of the words in `words`.
  template <OrOptional<std::string> T>
  void choice(Key key, T& value, std::vector<std::string> words, std::string_view meaning) {
    Field field{std::move(key), FieldType::choice, std::string(meaning)};
    field.choices = std::move(words);
    leaf<std::string>(std::move(field), value);
  }
  /// A list of such words.
  template <OrOptional<std::vector<std::string>> T>
  void choices(Key key, T& value, std::vector<std::string> words, std::string_view meaning) {
    Field field{std::move(key), FieldType::choices, std::string(meaning)};
    field.choices = std::move(words);
    leaf<std::vector<std::string>>(std::move(field), value);
  }
  /// A file or folder, which must exist; relative to the folder of the case file.
  template <OrOptional<std::filesystem::path> T>
  void path(Key key, T& value, std::string_view meaning) {
    leaf<std::filesystem::path>({std::move(key), FieldType::path, std::string(meaning)}, value);
  }
  /// One or more such files; a pattern like "stones/*.obj" stands for all that match it, sorted by name.
  template <OrOptional<std::vector<std::filesystem::path>> T>
  void paths(Key key, T& value, std::string_view meaning) {
    leaf<std::vector<std::filesystem::path>>({std::move(key), FieldType::paths, std::string(meaning)}, value);
  }

  /// A table inside this one, declared by its own `declare`. May be std::optional<T>.
  template <class T>
  void section(Key key, T& value, std::string_view meaning);
  /// A table whose keys depend on its kind. May be absent unless required.
  template <class Base>
  void section(Key key, OneOf<Base>& value, const Kinds<Base>& kinds, std::string_view meaning);
  /// Tables by name, in the order of their names: [materials.ballast].
  template <class T>
  void table(Key key, std::map<std::string, T>& value, std::string_view meaning);
  template <class Base>
  void table(Key key, std::map<std::string, OneOf<Base>>& value, const Kinds<Base>& kinds,
             std::string_view meaning);
  /// An array of tables: [[stages]].
  template <class T>
  void sequence(Key key, std::vector<T>& value, std::string_view meaning);
  template <class Base>
  void sequence(Key key, std::vector<OneOf<Base>>& value, const Kinds<Base>& kinds, std::string_view meaning);

  /// A rule between keys of one table, said after them: f.check(in.low < in.high, "high", "high must be above
  /// low", "low is 3 N here"). Reported at `key`; kept quiet when the table has other errors.
  virtual void check(bool ok, std::string_view key, std::string_view problem, std::string_view hint) = 0;

  /// A number that the run leaves because of this table. NUMBER in its name stands for one. `does`: whether
  /// it leaves it with the values at hand.
  void gives(std::string_view name, Dimension dimension, std::string_view meaning, bool does = true) {
    visit_result(name, dimension, meaning, does);
  }

  /// Where this table stands in the file ("stages.2"), for errors found later: Document::fail. Empty when
  /// nothing is read.
  virtual std::string here() const { return {}; }

 protected:
  /// Returns the value found in the file; nothing when the default stands.
  virtual std::optional<Value> visit(const Field& field, const std::optional<Value>& current) = 0;
  virtual void visit(const Field& field, Elements& elements) = 0;
  virtual void visit_result(std::string_view /*name*/, Dimension, std::string_view /*meaning*/,
                            bool /*does*/) {}

 private:
  template <class V, class T>
  void leaf(Field field, T& value) {
    if (const auto read = visit(field, Value(static_cast<V>(value))))
      value = static_cast<T>(std::get<V>(*read));
  }
  template <class V, class T>
  void leaf(Field field, std::optional<T>& value) {
    field.optional = true;
    std::optional<Value> current;
    if (value) current = Value(static_cast<V>(*value));
    if (const auto read = visit(field, current)) value = static_cast<T>(std::get<V>(*read));
  }
  // Limits of the integer type itself are limits of the input. Those of 64 bits are the file format's own.
  template <class T>
  static Field integer_field(Key key, Range range, std::string_view meaning) {
    if constexpr (sizeof(T) < 8) {
      if (!range.at_most && !range.below) range.at_most = static_cast<double>(std::numeric_limits<T>::max());
    }
    if constexpr (sizeof(T) < 8 || std::unsigned_integral<T>) {
      if (!range.at_least && !range.above)
        range.at_least = static_cast<double>(std::numeric_limits<T>::min());
    }
    return {std::move(key), FieldType::integer, std::string(meaning), Dimension::none, range};
  }
};

}  // namespace trackbed

#include "io/elements.h"  // the templates of section, table and sequence
