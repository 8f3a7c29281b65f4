// Files for ParaView and VTK: .vtp (surfaces, lines, points; XML with zlib-packed base64 data) and .pvd
// (which of them belong to which time). Readers of both exist in every ParaView from 4 on.
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <variant>
#include <vector>

#include "base/vec.h"
#include "geom/mesh.h"

namespace trackbed {

/// Values at every point or cell, under a name that says its unit: "speed [m/s]". Real numbers are written
/// with 7 digits (32 bits): pictures need no more, and files are half as large.
struct DataArray {
  std::string name;
  std::variant<std::vector<double>, std::vector<std::int64_t>> values;
  int components = 1;  // 3: vectors, as x y z x y z ...

  std::size_t size() const;  ///< entries, each of `components` values
};

/// An array of vectors.
DataArray vector_array(std::string name, std::span<const Vec3> vectors);

/// Points and the cells between them. Cell data come in the order vertices, lines, triangles.
struct PolyData {
  std::vector<Vec3> points;            // [m]
  std::vector<std::int64_t> vertices;  // points shown as such
  std::vector<std::array<std::int64_t, 2>> lines;
  std::vector<std::array<std::int64_t, 3>> triangles;
  std::vector<DataArray> point_data, cell_data;

  std::size_t n_cells() const { return vertices.size() + lines.size() + triangles.size(); }
};

/// A mesh somewhere in the world: a stone or a wall.
struct PosedMesh {
  const TriangleMesh* mesh = nullptr;
  Pose pose;
  double scale = 1.0;
};

/// Stones or walls as surfaces; `data` has one entry for each of them and is given to all their triangles.
PolyData surfaces(std::span<const PosedMesh> meshes, const std::vector<DataArray>& data);

/// Balls or pebbles as points with the array "radius [m]"; show them with Glyph or Point Gaussian. `data` has
/// one entry for each.
PolyData spheres(std::span<const Vec3> centres, std::span<const double> radii,
                 const std::vector<DataArray>& data);

/// Contacts as lines between two points; `data` has one entry for each.
PolyData lines_between(std::span<const Vec3> from, std::span<const Vec3> to,
                       const std::vector<DataArray>& data);

/// Writes a .vtp file, whole or not at all. Throws RunError when it cannot be written, std::logic_error when
/// an array has not one entry for every point or cell.
void write_vtp(const std::filesystem::path& path, const PolyData& data);

/// The .pvd file of a run. It is written anew, whole, with every file added, so that it can be opened while
/// the run goes on.
class TimeSeries {
 public:
  struct Entry {
    double time;       // [s]
    std::string file;  // relative to the folder of the .pvd
    int part;          // files of one time are parts of one picture
    template <class A>
    void archive(A& a) {
      a(time, file, part);
    }
  };

  explicit TimeSeries(std::filesystem::path path) : path_(std::move(path)) {}

  /// `file` must lie in the folder of the .pvd or below. Throws RunError when the .pvd cannot be written.
  void add(double time, const std::filesystem::path& file, int part = 0);

  const std::vector<Entry>& entries() const { return entries_; }

  /// The entries so far; the file itself is written anew with the next one.
  template <class A>
  void archive(A& a) {
    a(entries_);
  }

 private:
  void write() const;
  std::filesystem::path path_;
  std::vector<Entry> entries_;
};

}  // namespace trackbed
