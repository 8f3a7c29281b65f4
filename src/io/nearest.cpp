#include "io/nearest.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

namespace trackbed {

std::size_t edit_distance(std::string_view a, std::string_view b) {
  // distance[i][j] of the first i letters of a from the first j of b.
  std::vector<std::vector<std::size_t>> distance(a.size() + 1, std::vector<std::size_t>(b.size() + 1));
  for (std::size_t i = 0; i <= a.size(); ++i) {
    for (std::size_t j = 0; j <= b.size(); ++j) {
      std::size_t& best = distance[i][j];
      if (i == 0 || j == 0) {
        best = i + j;
        continue;
      }
      best = std::min({distance[i - 1][j] + 1, distance[i][j - 1] + 1,
                       distance[i - 1][j - 1] + (a[i - 1] == b[j - 1] ? 0u : 1u)});
      const bool swapped = i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1];
      if (swapped) best = std::min(best, distance[i - 2][j - 2] + 1);
    }
  }
  return distance[a.size()][b.size()];
}

namespace {

/// The known words, nearest first; the given order among equals.
std::vector<std::string> by_distance(std::string_view word, std::vector<std::string> known) {
  constexpr std::size_t longest = 64;  // longer words are compared by their beginning
  word = word.substr(0, longest);
  std::vector<std::pair<std::size_t, std::string>> ranked;
  for (std::string& candidate : known) {
    const std::size_t distance = edit_distance(word, std::string_view(candidate).substr(0, longest));
    ranked.emplace_back(distance, std::move(candidate));
  }
  std::stable_sort(ranked.begin(), ranked.end(),
                   [](const auto& a, const auto& b) { return a.first < b.first; });
  std::vector<std::string> sorted;
  for (auto& [distance, candidate] : ranked) sorted.push_back(std::move(candidate));
  return sorted;
}

}  // namespace

std::string known_words(std::string_view word, const std::vector<std::string>& known, std::size_t most) {
  if (known.empty()) return "nothing is allowed here";
  std::vector<std::string> sorted = by_distance(word, known);
  sorted.resize(std::min(sorted.size(), most));
  const std::size_t allowed = std::max<std::size_t>(1, std::min(word.size(), sorted.front().size()) / 2);
  const bool longer =
      word.size() > 2 && (word.starts_with(sorted.front()) || sorted.front().starts_with(word));
  const bool near = word.size() <= 64 && (longer || edit_distance(word, sorted.front()) <= allowed);
  const std::string list = fmt::format("known here: {}", fmt::join(sorted, ", "));
  return near ? fmt::format("did you mean {}? {}", sorted.front(), list) : list;
}

}  // namespace trackbed
