#include "io/diagnostics.h"

#include <fmt/format.h>

#include <algorithm>
#include <tuple>

#include "base/error.h"

namespace trackbed {
namespace {

std::string_view line_of(std::string_view text, int line) {
  for (int i = 1; i < line; ++i) {
    const std::size_t end = text.find('\n');
    if (end == std::string_view::npos) return {};
    text.remove_prefix(end + 1);
  }
  return text.substr(0, text.find_first_of("\r\n"));
}

/// The characters of a line: a tab counts as one blank, as in the columns; nothing that could steer a
/// terminal.
std::vector<std::string> printable_characters(std::string_view line) {
  std::vector<std::string> characters;
  for (char c : line) {
    const auto byte = static_cast<unsigned char>(c);
    if ((byte & 0xC0u) == 0x80u && !characters.empty())
      characters.back() += c;  // the rest of a longer character
    else
      characters.emplace_back(1, byte < 0x20 || byte == 0x7F ? ' ' : c);
  }
  for (std::string& character : characters) {
    const auto first = static_cast<unsigned char>(character[0]);
    const std::size_t length = first < 0x80 ? 1 : first < 0xC2 ? 0 : first < 0xE0 ? 2 : first < 0xF0 ? 3 : 4;
    const bool control =
        first == 0xC2 && character.size() == 2 && static_cast<unsigned char>(character[1]) < 0xA0;
    if (character.size() != length || control) character = "?";
  }
  return characters;
}

/// The line with a caret under the place; of a very long line only the surroundings.
std::string excerpt(std::string_view line, const Place& place) {
  constexpr int width = 100;
  const std::vector<std::string> characters = printable_characters(line);
  const int n = static_cast<int>(characters.size());
  const int caret = std::clamp(place.column - 1, 0, n);
  const int first = n > width && caret > width / 2 ? caret - width / 2 : 0;
  const int last = std::min(n, first + width);
  std::string shown;
  for (int i = first; i < last; ++i) shown += characters[static_cast<std::size_t>(i)];
  const int length = std::clamp(place.length, 1, std::max(1, last - caret));
  const std::string number = fmt::format("{}", place.line);
  return fmt::format("  {} | {}\n  {:{}} | {:{}}^{:~<{}}\n", number, shown, "", number.size(), "",
                     caret - first, "", length - 1);
}

}  // namespace

void Diagnostics::add(const Place& place, std::string problem, std::string hint) {
  errors_.push_back({place, std::move(problem), std::move(hint)});
}

std::string Diagnostics::show(const Error& error) const {
  std::string text;
  if (error.place.override_index >= 0) {
    const auto index = static_cast<std::size_t>(error.place.override_index);
    text = fmt::format("--set {}: error: {}\n", source_.overrides[index], error.problem);
  } else if (error.place.line == 0) {
    text = fmt::format("{}: error: {}\n", source_.name, error.problem);
  } else {
    text = fmt::format("{}:{}:{}: error: {}\n", source_.name, error.place.line, error.place.column,
                       error.problem);
    text += excerpt(line_of(source_.text, error.place.line), error.place);
  }
  if (!error.hint.empty()) text += fmt::format("  hint: {}\n", error.hint);
  return text;
}

void Diagnostics::throw_if_any() const {
  if (errors_.empty()) return;
  constexpr std::size_t most = 20;
  std::vector<Error> sorted = errors_;
  // Those of the file from top to bottom, then those of the overrides as they were given.
  std::stable_sort(sorted.begin(), sorted.end(), [](const Error& a, const Error& b) {
    return std::tuple(a.place.override_index, a.place.line, a.place.column) <
           std::tuple(b.place.override_index, b.place.line, b.place.column);
  });
  std::string text;
  for (std::size_t i = 0; i < std::min(most, sorted.size()); ++i) text += show(sorted[i]);
  if (sorted.size() > most) text += fmt::format("... and {} more errors\n", sorted.size() - most);
  text.pop_back();  // the program ends the line
  throw InputError(text);
}

}  // namespace trackbed
