// All contact laws. To add one: a header with a struct like Linear, a LawKind, and a row in with_law and
// law_names.
#pragma once

#include <array>
#include <string_view>

#include "dem/laws/linear.h"
#include "dem/laws/linear_rolling.h"

namespace trackbed {

/// Calls function.operator()<Law>() for the law of the given kind: chosen once a pair, inlined in its
/// contacts.
template <class Function>
void with_law(LawKind kind, Function&& function) {
  switch (kind) {
    case LawKind::linear:
      return function.template operator()<Linear>();
    case LawKind::linear_rolling:
      return function.template operator()<LinearRolling>();
  }
}

inline constexpr std::array<std::pair<std::string_view, LawKind>, 2> law_names{
    {{Linear::name, Linear::kind}, {LinearRolling::name, LinearRolling::kind}}};

}  // namespace trackbed
