// Which known word did the user mean?
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace trackbed {

/// Letters to insert, delete, replace or swap with their neighbour to turn one word into the other (optimal
/// string alignment; Damerau 1964).
std::size_t edit_distance(std::string_view a, std::string_view b);

/// So many of the nearest words are enough of a long list.
inline constexpr std::size_t few_words = 6;

/// "did you mean friction? Known are friction, kn, ks": all known words, nearest first. The question is put
/// only when the nearest is near. `most`, at least 1: of the nearest words, no more than these.
std::string known_words(std::string_view word, const std::vector<std::string>& known,
                        std::size_t most = std::string::npos);

}  // namespace trackbed
