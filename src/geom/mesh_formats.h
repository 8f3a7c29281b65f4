// The three mesh formats, each in its own file, and what they share. Inside geom only: others call read_mesh.
#pragma once

#include <fmt/format.h>

#include <cmath>
#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "base/error.h"
#include "geom/mesh.h"

namespace trackbed::formats {

/// A file held in memory, and the place reached in it. Every length is checked against what the file really
/// holds, so a corrupt count never makes a large allocation.
class MeshFile {
 public:
  MeshFile(std::filesystem::path path, std::string bytes)
      : path_(std::move(path)), bytes_(std::move(bytes)) {}

  std::string_view bytes() const { return bytes_; }
  std::size_t left() const { return bytes_.size() - at_; }
  void skip(std::size_t count) { at_ += count; }
  const char* here() const { return bytes_.data() + at_; }

  /// The next line without its end, or nothing at the end of the file.
  std::optional<std::string_view> next_line();

  /// Throws InputError "FILE: what" or, once a line has been read, "FILE, line N: what".
  [[noreturn]] void fail(std::string_view what) const;

 private:
  std::filesystem::path path_;
  std::string bytes_;
  std::size_t at_ = 0;
  int line_ = 0;
};

/// Cuts a line at blanks.
std::vector<std::string_view> words_of(std::string_view line);

/// Reads words[first], [first+1], [first+2] as a point; fails when a number is missing, malformed or not
/// finite.
Vec3 read_point(const MeshFile& file, const std::vector<std::string_view>& words, std::size_t first);

double read_number(const MeshFile& file, std::string_view word);
long long read_integer(const MeshFile& file, std::string_view word);

/// Adds a polygon as a fan of triangles; fails when it has fewer than three corners.
void add_polygon(const MeshFile& file, const std::vector<int>& corners, TriangleMesh& mesh);

TriangleMesh read_stl(MeshFile file);
TriangleMesh read_obj(MeshFile file);
TriangleMesh read_ply(MeshFile file);

}  // namespace trackbed::formats
