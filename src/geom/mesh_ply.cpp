// PLY: a text header that declares elements and their properties, then the data as text or binary.
#include <algorithm>
#include <bit>
#include <cstdint>
#include <map>
#include <tuple>

#include "geom/mesh_formats.h"

namespace trackbed::formats {
namespace {

enum class Coding { text, little, big };

struct Property {
  std::string name;
  char type = 'f';        // i, u or f
  std::size_t size = 4;   // bytes of a binary value
  std::size_t count = 0;  // bytes of a list's count; 0 for a single value
};

struct Element {
  std::string name;
  std::size_t count = 0;
  std::vector<Property> properties;
};

struct Header {
  Coding coding = Coding::text;
  std::vector<Element> elements;
};

std::pair<char, std::size_t> type_of(const MeshFile& file, std::string_view word) {
  static const std::map<std::string_view, std::pair<char, std::size_t>> types = {
      {"char", {'i', 1}},  {"uchar", {'u', 1}},  {"short", {'i', 2}},   {"ushort", {'u', 2}},
      {"int", {'i', 4}},   {"uint", {'u', 4}},   {"float", {'f', 4}},   {"double", {'f', 8}},
      {"int8", {'i', 1}},  {"uint8", {'u', 1}},  {"int16", {'i', 2}},   {"uint16", {'u', 2}},
      {"int32", {'i', 4}}, {"uint32", {'u', 4}}, {"float32", {'f', 4}}, {"float64", {'f', 8}}};
  const auto found = types.find(word);
  if (found == types.end()) file.fail(fmt::format("\"{}\" is not a PLY type", word));
  return found->second;
}

Coding coding_of(const MeshFile& file, std::string_view word) {
  if (word == "ascii") return Coding::text;
  if (word == "binary_little_endian") return Coding::little;
  if (word == "binary_big_endian") return Coding::big;
  file.fail(fmt::format("the PLY format \"{}\" is not known", word));
}

Property property_of(const MeshFile& file, const std::vector<std::string_view>& words) {
  const bool list = words.size() == 5 && words[1] == "list";
  if (!list && words.size() != 3) file.fail("a property needs a type and a name");
  Property property{std::string(words.back())};
  std::tie(property.type, property.size) = type_of(file, words[words.size() - 2]);
  if (list) {
    const auto [type, size] = type_of(file, words[2]);
    if (type == 'f') file.fail("the count of a list must be a whole number");
    property.count = size;
  }
  return property;
}

Header read_header(MeshFile& file) {
  Header header;
  if (file.next_line() != "ply") file.fail("a PLY file begins with \"ply\"");
  while (const auto line = file.next_line()) {
    const auto words = words_of(*line);
    if (words.empty() || words[0] == "comment" || words[0] == "obj_info") continue;
    if (words[0] == "end_header") return header;
    if (words[0] == "format" && words.size() == 3) {
      header.coding = coding_of(file, words[1]);
    } else if (words[0] == "element" && words.size() == 3) {
      const long long count = read_integer(file, words[2]);
      // Each element takes at least one byte of the file.
      if (count < 0 || static_cast<std::size_t>(count) > file.bytes().size())
        file.fail(fmt::format("the file is cut off or corrupt: it announces {} of element \"{}\" in {} bytes",
                              count, words[1], file.bytes().size()));
      header.elements.push_back({std::string(words[1]), static_cast<std::size_t>(count), {}});
    } else if (words[0] == "property" && !header.elements.empty()) {
      header.elements.back().properties.push_back(property_of(file, words));
    } else {
      file.fail(fmt::format("\"{}\" is not understood", *line));
    }
  }
  file.fail("the file is cut off: its header has no end");
}

/// The values of the data part one after the other, whatever their coding.
class Values {
 public:
  Values(MeshFile& file, Coding coding) : file_(file), coding_(coding) {}

  double next(char type, std::size_t size) {
    if (coding_ == Coding::text) return next_word();
    if (file_.left() < size) file_.fail("the file is cut off");
    std::uint64_t word = 0;
    for (std::size_t k = 0; k < size; ++k) {
      const char byte = file_.here()[coding_ == Coding::big ? k : size - 1 - k];
      word = word << 8 | static_cast<unsigned char>(byte);
    }
    file_.skip(size);
    return value_of(word, type, size);
  }

 private:
  double next_word() {
    while (word_ == words_.size()) {
      const auto line = file_.next_line();
      if (!line) file_.fail("the file is cut off");
      words_ = words_of(*line);
      word_ = 0;
    }
    return read_number(file_, words_[word_++]);
  }

  double value_of(std::uint64_t word, char type, std::size_t size) const {
    if (type == 'f') {
      const double value = size == 8 ? std::bit_cast<double>(word)
                                     : double{std::bit_cast<float>(static_cast<std::uint32_t>(word))};
      if (!std::isfinite(value)) file_.fail("a coordinate is not finite");
      return value;
    }
    const unsigned shift = static_cast<unsigned>(64 - 8 * size);
    return type == 'i' ? static_cast<double>(static_cast<std::int64_t>(word << shift) >> shift)
                       : static_cast<double>(word);
  }

  MeshFile& file_;
  Coding coding_;
  std::vector<std::string_view> words_;
  std::size_t word_ = 0;
};

void read_list(MeshFile& file, Values& values, const Property& property, std::vector<double>& list) {
  const double count = values.next('u', property.count);
  if (count < 0 || count > static_cast<double>(file.bytes().size())) file.fail("a list has an absurd length");
  list.clear();
  for (double k = 0; k < count; ++k) list.push_back(values.next(property.type, property.size));
}

int axis_of(const Property& property) {
  return property.name == "x" ? 0 : property.name == "y" ? 1 : property.name == "z" ? 2 : -1;
}

void read_element(MeshFile& file, Values& values, const Element& element, TriangleMesh& mesh) {
  const bool vertex = element.name == "vertex", face = element.name == "face";
  std::vector<double> list;
  Vec3 point = Vec3::Zero();
  for (const Property& property : element.properties) {
    if (property.count) {
      read_list(file, values, property, list);
      if (!face || (property.name != "vertex_indices" && property.name != "vertex_index")) continue;
      for (double corner : list)
        if (corner < 0 || corner > 2147483647.0) file.fail(fmt::format("there is no vertex {}", corner));
      add_polygon(file, {list.begin(), list.end()}, mesh);
    } else {
      const double value = values.next(property.type, property.size);
      if (vertex && axis_of(property) >= 0) point[axis_of(property)] = value;
    }
  }
  if (vertex) mesh.vertices.push_back(point);
}

}  // namespace

TriangleMesh read_ply(MeshFile file) {
  const Header header = read_header(file);
  TriangleMesh mesh;
  Values values(file, header.coding);
  for (const Element& element : header.elements) {
    const auto axes = std::count_if(element.properties.begin(), element.properties.end(),
                                    [](const Property& p) { return axis_of(p) >= 0 && p.count == 0; });
    if (element.name == "vertex" && axes != 3) file.fail("the vertices need the properties x, y and z");
    if (element.properties.empty()) continue;
    for (std::size_t k = 0; k < element.count; ++k) read_element(file, values, element, mesh);
  }
  for (const auto& facet : mesh.facets)
    for (int corner : facet)
      if (corner >= static_cast<int>(mesh.vertices.size()))
        file.fail(fmt::format("a facet names vertex {}, but the file has only {} (counted from 0)", corner,
                              mesh.vertices.size()));
  return mesh;
}

}  // namespace trackbed::formats
