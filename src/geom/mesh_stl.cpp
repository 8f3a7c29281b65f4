// STL: 80 bytes of anything, a count, 50 bytes a facet; or text, "facet normal ... vertex x y z ...
// endfacet".
#include <array>
#include <bit>
#include <cstdint>
#include <unordered_map>

#include "base/hash.h"
#include "geom/mesh_formats.h"

namespace trackbed::formats {
namespace {

constexpr std::size_t header_size = 84, facet_size = 50;

std::uint32_t word_at(const char* bytes) {
  std::uint32_t word = 0;
  for (int k = 0; k < 4; ++k)
    word |= static_cast<std::uint32_t>(static_cast<unsigned char>(bytes[k])) << (8 * k);
  return word;
}

/// Gives each distinct point a number, in the order of first appearance.
class VertexMerger {
 public:
  explicit VertexMerger(TriangleMesh& mesh) : mesh_(mesh) {}
  int number(Vec3 p) {
    p += Vec3::Zero();  // -0 and 0 are the same place
    const auto [found, is_new] = numbers_.try_emplace({p.x(), p.y(), p.z()}, numbers_.size());
    if (is_new) mesh_.vertices.push_back(p);
    return static_cast<int>(found->second);
  }

 private:
  struct PointHash {
    std::size_t operator()(const std::array<double, 3>& p) const {
      Hash hash;
      for (double x : p) hash.add(x);
      return hash.value();
    }
  };
  TriangleMesh& mesh_;
  std::unordered_map<std::array<double, 3>, std::size_t, PointHash> numbers_;
};

TriangleMesh read_binary(MeshFile& file) {
  const std::size_t count = word_at(file.here() + 80);
  file.skip(header_size);
  if (count > file.left() / facet_size)
    file.fail(fmt::format("the file is cut off or corrupt: it announces {} facets and has room for {}", count,
                          file.left() / facet_size));
  TriangleMesh mesh;
  mesh.facets.reserve(count);
  VertexMerger merger(mesh);
  for (std::size_t f = 0; f < count; ++f, file.skip(facet_size)) {
    std::array<int, 3> facet{};
    for (std::size_t corner = 0; corner < 3; ++corner) {
      Vec3 p;
      for (std::size_t axis = 0; axis < 3; ++axis)
        p[static_cast<Eigen::Index>(axis)] =
            std::bit_cast<float>(word_at(file.here() + 12 + 12 * corner + 4 * axis));
      if (!p.allFinite()) file.fail(fmt::format("facet {} has a coordinate that is not finite", f + 1));
      facet[corner] = merger.number(p);
    }
    mesh.facets.push_back(facet);
  }
  return mesh;
}

TriangleMesh read_text(MeshFile& file) {
  TriangleMesh mesh;
  VertexMerger merger(mesh);
  std::vector<int> corners;
  bool in_facet = false, ended = false;
  while (const auto line = file.next_line()) {
    const auto words = words_of(*line);
    if (words.empty()) continue;
    if (words[0] == "facet") {
      if (in_facet) file.fail("a facet begins before the last one ended");
      in_facet = true;
      corners.clear();
    } else if (words[0] == "vertex") {
      corners.push_back(merger.number(read_point(file, words, 1)));
    } else if (words[0] == "endfacet") {
      if (!in_facet) file.fail("\"endfacet\" without a facet");
      add_polygon(file, corners, mesh);
      in_facet = false;
    }
    ended = words[0] == "endsolid";
  }
  if (!ended) file.fail("the file is cut off: it ends without \"endsolid\"");
  return mesh;
}

}  // namespace

TriangleMesh read_stl(MeshFile file) {
  const std::string_view bytes = file.bytes();
  // Many binary files begin with "solid" too, so the size decides first.
  const bool exact = bytes.size() >= header_size &&
                     bytes.size() == header_size + facet_size * std::size_t{word_at(bytes.data() + 80)};
  const bool text = bytes.starts_with("solid") && bytes.substr(0, 4096).find('\0') == bytes.npos;
  if (text && !exact) return read_text(file);
  if (bytes.size() < header_size)
    file.fail(fmt::format("the file is cut off: {} bytes are too few for an STL file", bytes.size()));
  return read_binary(file);
}

}  // namespace trackbed::formats
