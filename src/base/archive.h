// Things as bytes and back. A type tells its parts once, in `void archive(Archive&)` or a free function
// `archive(Archive&, T&)`; the archive writes them, or reads them back to the same bits.
#pragma once

#include <cstdint>
#include <cstring>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>
#include <vector>

#include "base/error.h"
#include "base/vec.h"

namespace trackbed {

class Archive {
 public:
  /// Writes.
  Archive() = default;
  /// Reads what another has written. Throws RunError when the bytes end before all is read.
  explicit Archive(std::string bytes) : bytes_(std::move(bytes)), reads_(true) {}

  bool reads() const { return reads_; }
  const std::string& bytes() const { return bytes_; }

  template <class... T>
  void operator()(T&... parts) {
    (part(parts), ...);
  }

 private:
  void raw(void* data, std::size_t size) {
    if (!reads_) {
      bytes_.append(static_cast<const char*>(data), size);
      return;
    }
    if (size > bytes_.size() - at_) throw RunError("the saved state ends too early");
    if (size > 0) std::memcpy(data, bytes_.data() + at_, size);
    at_ += size;
  }

  template <class T>
  void part(T& value) {
    if constexpr (requires { value.archive(*this); }) {
      value.archive(*this);
    } else if constexpr (std::is_arithmetic_v<T> || std::is_enum_v<T>) {
      raw(&value, sizeof value);
    } else {
      archive(*this, value);
    }
  }
  template <class T, int rows, int columns>
  void part(Eigen::Matrix<T, rows, columns>& m) {
    static_assert(rows != Eigen::Dynamic && columns != Eigen::Dynamic);
    raw(m.data(), sizeof(T) * static_cast<std::size_t>(m.size()));
  }
  void part(Quat& q) { part(q.coeffs()); }
  void part(Pose& pose) { (*this)(pose.position, pose.orientation); }
  void part(Eigen::AlignedBox3d& box) { (*this)(box.min(), box.max()); }
  void part(std::string& text) {
    std::uint64_t size = text.size();
    part(size);
    // Not to be taken for a length before it is known to be one.
    if (reads_ && size > bytes_.size() - at_) throw RunError("the saved state ends too early");
    text.resize(size);
    raw(text.data(), size);
  }
  template <class T>
  void part(std::vector<T>& values) {
    std::uint64_t size = values.size();
    part(size);
    if (reads_ && size > bytes_.size() - at_) throw RunError("the saved state ends too early");
    values.resize(size);
    if constexpr (std::is_arithmetic_v<T>)
      raw(values.data(), sizeof(T) * values.size());
    else
      for (T& value : values) part(value);
  }
  template <class T, std::size_t n>
  void part(std::array<T, n>& values) {
    for (T& value : values) part(value);
  }
  template <class T>
  void part(std::optional<T>& value) {
    bool is_there = value.has_value();
    part(is_there);
    if (reads_) value = is_there ? std::optional<T>(std::in_place) : std::nullopt;
    if (is_there) part(*value);
  }
  template <class K, class V>
  void part(std::map<K, V>& values) {
    std::uint64_t size = values.size();
    part(size);
    if (!reads_) {
      for (auto& [key, value] : values) {
        K copy = key;
        (*this)(copy, value);
      }
      return;
    }
    values.clear();
    for (std::uint64_t k = 0; k < size; ++k) {
      std::pair<K, V> entry;
      (*this)(entry.first, entry.second);
      values.insert(values.end(), std::move(entry));
    }
  }

  std::string bytes_;
  std::size_t at_ = 0;
  bool reads_ = false;
};

}  // namespace trackbed
