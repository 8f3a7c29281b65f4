#include "geom/mesh_io.h"

#include <algorithm>
#include <bit>
#include <cctype>
#include <charconv>
#include <cstdint>
#include <fstream>
#include <sstream>

#include "geom/mesh_formats.h"

namespace trackbed {
namespace formats {

std::optional<std::string_view> MeshFile::next_line() {
  if (at_ >= bytes_.size()) return {};
  const std::size_t end = std::min(bytes_.find('\n', at_), bytes_.size());
  std::string_view line = std::string_view(bytes_).substr(at_, end - at_);
  at_ = std::min(end + 1, bytes_.size());
  ++line_;
  if (!line.empty() && line.back() == '\r') line.remove_suffix(1);
  return line;
}

void MeshFile::fail(std::string_view what) const {
  throw InputError(line_ ? fmt::format("{}, line {}: {}", path_.string(), line_, what)
                         : fmt::format("{}: {}", path_.string(), what));
}

std::vector<std::string_view> words_of(std::string_view line) {
  std::vector<std::string_view> words;
  const auto blank = [](char c) { return c == ' ' || c == '\t' || c == '\r'; };
  for (std::size_t k = 0; k < line.size();) {
    if (blank(line[k])) {
      ++k;
      continue;
    }
    const std::size_t begin = k;
    while (k < line.size() && !blank(line[k])) ++k;
    words.push_back(line.substr(begin, k - begin));
  }
  return words;
}

double read_number(const MeshFile& file, std::string_view word) {
  double value = 0;
  if (word.starts_with('+')) word.remove_prefix(1);
  const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
  const bool whole = end == word.data() + word.size();
  // A number too small for a double is as good as zero; one too large is as bad as infinite.
  if (error == std::errc::result_out_of_range && whole && word.find("e-") != word.npos) return 0;
  if (error != std::errc{} || !whole) file.fail(fmt::format("\"{}\" is not a number", word));
  if (!std::isfinite(value)) file.fail(fmt::format("the number {} is not finite", word));
  return value;
}

long long read_integer(const MeshFile& file, std::string_view word) {
  long long value = 0;
  const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
  if (error != std::errc{} || end != word.data() + word.size())
    file.fail(fmt::format("\"{}\" is not a whole number", word));
  return value;
}

Vec3 read_point(const MeshFile& file, const std::vector<std::string_view>& words, std::size_t first) {
  if (words.size() < first + 3) file.fail("a vertex needs three coordinates");
  return {read_number(file, words[first]), read_number(file, words[first + 1]),
          read_number(file, words[first + 2])};
}

void add_polygon(const MeshFile& file, const std::vector<int>& corners, TriangleMesh& mesh) {
  if (corners.size() < 3) file.fail(fmt::format("a facet has {} corners; it needs three", corners.size()));
  for (std::size_t k = 1; k + 1 < corners.size(); ++k)
    mesh.facets.push_back({corners[0], corners[k], corners[k + 1]});
}

}  // namespace formats

namespace {

std::string read_all(const std::filesystem::path& path) {
  if (!std::filesystem::exists(path)) throw InputError(path.string() + ": there is no such file");
  if (!std::filesystem::is_regular_file(path)) throw InputError(path.string() + ": this is not a file");
  std::ifstream in(path, std::ios::binary);
  std::ostringstream text;
  if (in.peek() != std::ifstream::traits_type::eof()) text << in.rdbuf();
  if (!in && !in.eof()) throw InputError(path.string() + ": the file cannot be read");
  return std::move(text).str();
}

std::string lower_ending(const std::filesystem::path& path) {
  std::string ending = path.extension().string();
  std::transform(ending.begin(), ending.end(), ending.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return ending;
}

void put_bytes(std::string& bytes, std::uint32_t word) {
  for (int shift = 0; shift < 32; shift += 8) bytes.push_back(static_cast<char>((word >> shift) & 0xff));
}

void put_bytes(std::string& bytes, const Vec3& v) {
  for (double x : v) put_bytes(bytes, std::bit_cast<std::uint32_t>(static_cast<float>(x)));
}

}  // namespace

TriangleMesh read_mesh(const std::filesystem::path& path, double unit) {
  const std::string ending = lower_ending(path);
  TriangleMesh (*reader)(formats::MeshFile) = ending == ".stl"   ? formats::read_stl
                                              : ending == ".obj" ? formats::read_obj
                                              : ending == ".ply" ? formats::read_ply
                                                                 : nullptr;
  if (!reader)
    throw InputError(fmt::format("{}: the ending \"{}\" is not known; a stone is an .stl, .obj or .ply file",
                                 path.string(), ending));
  TriangleMesh mesh = reader({path, read_all(path)});
  if (mesh.facets.empty()) throw InputError(path.string() + ": the file holds no facets");
  for (Vec3& v : mesh.vertices) v *= unit;
  return mesh;
}

void write_stl(const TriangleMesh& mesh, const std::filesystem::path& path) {
  std::string bytes = "binary STL of Trackbed";
  bytes.resize(80, ' ');
  put_bytes(bytes, static_cast<std::uint32_t>(mesh.facets.size()));
  for (std::size_t f = 0; f < mesh.facets.size(); ++f) {
    const auto [a, b, c] = mesh.corners(f);
    put_bytes(bytes, (b - a).cross(c - a).stableNormalized());
    for (const Vec3& corner : {a, b, c}) put_bytes(bytes, corner);
    bytes.append(2, '\0');
  }
  std::ofstream out(path, std::ios::binary);
  out.write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
  out.close();
  if (!out) throw InputError(path.string() + ": the file cannot be written");
}

}  // namespace trackbed
