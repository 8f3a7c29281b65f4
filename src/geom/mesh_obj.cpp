// Wavefront OBJ: of all its lines only "v x y z ..." and "f a b c ...", "f a/t/n ...", "f a//n ..." count.
#include "geom/mesh_formats.h"

namespace trackbed::formats {
namespace {

/// The vertex number (from 0) of "7", "7/1", "7//3" or "-1" (the vertex last read).
int corner_of(const MeshFile& file, std::string_view word, std::size_t vertices) {
  const long long number = read_integer(file, word.substr(0, word.find('/')));
  const long long count = static_cast<long long>(vertices);
  const long long index = number > 0 ? number - 1 : count + number;
  if (number == 0 || index < 0) file.fail(fmt::format("there is no vertex {}", number));
  if (index >= 1LL << 31) file.fail(fmt::format("vertex {} is beyond what a file can hold", number));
  return static_cast<int>(index);
}

}  // namespace

TriangleMesh read_obj(MeshFile file) {
  TriangleMesh mesh;
  std::vector<int> corners;
  while (const auto line = file.next_line()) {
    const auto words = words_of(line->substr(0, line->find('#')));
    if (words.empty()) continue;
    if (words[0] == "v") {
      mesh.vertices.push_back(read_point(file, words, 1));
    } else if (words[0] == "f") {
      corners.clear();
      for (std::size_t k = 1; k < words.size(); ++k)
        corners.push_back(corner_of(file, words[k], mesh.vertices.size()));
      add_polygon(file, corners, mesh);
    }
  }
  // A facet may name a vertex that stands below it, so this is checked last.
  for (const auto& facet : mesh.facets)
    for (int corner : facet)
      if (corner >= static_cast<int>(mesh.vertices.size()))
        file.fail(fmt::format("a facet names vertex {}, but the file has only {}; is it cut off?", corner + 1,
                              mesh.vertices.size()));
  return mesh;
}

}  // namespace trackbed::formats
