// Writes a declared struct (io/schema.h) back as it was understood, with every default filled in.
#pragma once

#include <nlohmann/json.hpp>

#include "io/schema.h"

namespace trackbed {

nlohmann::ordered_json echo_with(const std::function<void(Fields&)>& declare_all);

/// The resolved input: quantities as text with their SI unit, absent optional keys left out.
template <class T>
nlohmann::ordered_json echo(T input) {
  return echo_with([&](Fields& f) { declare(f, input); });
}

/// The keys in which two resolved inputs differ, "stones.ratio: 0.3 -> 0.4"; the first few.
std::string difference(const nlohmann::ordered_json& before, const nlohmann::ordered_json& after);

}  // namespace trackbed
