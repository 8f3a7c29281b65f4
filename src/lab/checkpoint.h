// Where a run stands, in files with a checksum: the last two of them.
#pragma once

#include <chrono>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>

namespace trackbed {

/// Begins each file. To be changed when what was written before means something else, as when the pebbles of
/// a shape come in another order.
inline constexpr std::string_view state_format = "trackbed state 3\n";

/// Writes bytes with their checksum, so that they lie on the disk when this returns. Throws RunError.
void write_checked(const std::filesystem::path& file, std::string_view bytes);

/// Reads them back; nothing when the file cannot be read, is another, or is not whole.
std::optional<std::string> read_checked(const std::filesystem::path& file);

class Checkpoints {
 public:
  /// In `folder`, which is made when there is something to write; due every so many seconds of wall time.
  Checkpoints(std::filesystem::path folder, double every);

  bool is_due() const;

  /// Writes a new one that lies on the disk when this returns, and drops all but the last two. Throws
  /// RunError.
  void write(std::string_view bytes);

  /// The bytes of the last whole one; nothing when there is no file. Throws InputError when there are files,
  /// but none is whole and of this format.
  std::optional<std::string> newest() const;

  /// Deletes all, when the run is over.
  void clear();

 private:
  std::filesystem::path folder_;
  double every_;  // [s]
  std::chrono::steady_clock::time_point last_ = std::chrono::steady_clock::now();
};

}  // namespace trackbed
