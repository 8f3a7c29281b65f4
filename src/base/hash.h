// A 64-bit fingerprint of raw bits, for telling whether two states are the same.
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <string_view>
#include <type_traits>

namespace trackbed {

/// FNV-1a over 64-bit words. Order matters; 0.0 and -0.0 differ.
class Hash {
 public:
  template <class T>
  void add(const T& value) requires std::is_trivially_copyable_v<T> &&(sizeof(T) <= 8) {
    std::uint64_t word = 0;
    std::memcpy(&word, &value, sizeof(T));
    mix(word);
  }
  void add(std::string_view text) {
    for (char c : text) add(c);
  }
  std::uint64_t value() const { return value_; }

 private:
  void mix(std::uint64_t word) {
    value_ = (value_ ^ word) * 0x100000001b3ULL;
    value_ ^= value_ >> 29;
  }
  std::uint64_t value_ = 0xcbf29ce484222325ULL;
};

}  // namespace trackbed
