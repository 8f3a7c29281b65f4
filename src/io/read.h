// Reads a TOML file into a declared struct (io/schema.h). All errors of a file are reported in one go.
#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "io/schema.h"

namespace trackbed {

/// A parsed input file together with the overrides of the command line.
class Document {
 public:
  /// `overrides`: "key=value" as given to --set: a dotted path ("stages.2.time", counted from 0, or
  /// "stages.load.time" by the name of an element, or its kind where it has none) and a TOML value; a bare
  /// word is a text. Throws InputError when the file cannot be read or is not TOML, or an override leads
  /// nowhere.
  explicit Document(const std::filesystem::path& file, const std::vector<std::string>& overrides = {});
  /// The same for text in memory; `name` stands for the file in messages, relative paths start from its
  /// folder.
  static Document from_text(std::string text, const std::filesystem::path& name,
                            const std::vector<std::string>& overrides = {});
  ~Document();
  Document(Document&&) noexcept;
  Document& operator=(Document&&) noexcept;

  /// Fills `input`; throws one InputError that lists up to 20 errors, each with line, caret and hint.
  template <class T>
  void read(T& input) const {
    read_with([&](Fields& f) { declare(f, input); });
  }

  /// Whether the file has this key at its top level.
  bool has(std::string_view key) const;

  /// For errors found later: throws InputError that points at a key, for example "stages.2.wall" (see
  /// Fields::here).
  [[noreturn]] void fail(std::string_view dotted_key, std::string_view problem, std::string_view hint) const;

  const std::filesystem::path& file() const;

 private:
  struct Parsed;
  explicit Document(std::unique_ptr<Parsed> parsed);
  void read_with(const std::function<void(Fields&)>& declare_all) const;
  std::unique_ptr<Parsed> parsed_;
};

/// Reads a whole file: read_input<CaseInput>("cases/box/case.toml", {"seed=3"}).
template <class T>
T read_input(const std::filesystem::path& file, const std::vector<std::string>& overrides = {}) {
  T input;
  Document(file, overrides).read(input);
  return input;
}

}  // namespace trackbed
