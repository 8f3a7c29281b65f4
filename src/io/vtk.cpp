#include "io/vtk.h"

#include <fmt/format.h>
#include <zlib.h>

#include <bit>
#include <cstring>
#include <new>
#include <stdexcept>

#include "base/error.h"
#include "io/files.h"

namespace trackbed {
namespace {

constexpr std::string_view byte_order =
    std::endian::native == std::endian::little ? "LittleEndian" : "BigEndian";

std::string escaped(std::string_view text) {
  std::string xml;
  for (char c : text) {
    switch (c) {
      case '&':
        xml += "&amp;";
        break;
      case '<':
        xml += "&lt;";
        break;
      case '>':
        xml += "&gt;";
        break;
      case '"':
        xml += "&quot;";
        break;
      default:
        xml += c;
    }
  }
  return xml;
}

void append_base64(std::string& text, std::string_view bytes) {
  constexpr std::string_view letters = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  text.reserve(text.size() + (bytes.size() + 2) / 3 * 4);
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    const std::size_t n = std::min<std::size_t>(3, bytes.size() - i);
    std::uint32_t group = 0;
    for (std::size_t j = 0; j < 3; ++j)
      group = (group << 8u) | (j < n ? static_cast<unsigned char>(bytes[i + j]) : 0u);
    for (std::size_t j = 0; j < 4; ++j) text += j <= n ? letters[(group >> (18u - 6u * j)) & 63u] : '=';
  }
}

template <class T>
std::string_view bytes_of(const std::vector<T>& values) {
  return {reinterpret_cast<const char*>(values.data()), values.size() * sizeof(T)};
}

/// The bytes as VTK wants them: in blocks packed by zlib, before them a header of 64-bit numbers: number of
/// blocks, bytes of a block, bytes of the last one when it is shorter (else 0), packed bytes of each.
std::string packed(std::string_view bytes) {
  constexpr std::size_t block = std::size_t{1} << 18;
  std::vector<std::uint64_t> header = {(bytes.size() + block - 1) / block, block, bytes.size() % block};
  std::string all;
  for (std::size_t begin = 0; begin < bytes.size(); begin += block) {
    const std::string_view part = bytes.substr(begin, block);
    uLongf size = compressBound(static_cast<uLong>(part.size()));
    std::string out(size, '\0');
    const int result =
        compress2(reinterpret_cast<Bytef*>(out.data()), &size, reinterpret_cast<const Bytef*>(part.data()),
                  static_cast<uLong>(part.size()), Z_BEST_SPEED);
    if (result != Z_OK) throw std::bad_alloc();  // the only way it fails with a large enough buffer
    header.push_back(size);
    all.append(out, 0, size);
  }
  std::string text;
  append_base64(text, bytes_of(header));
  append_base64(text, all);
  return text;
}

/// One <DataArray>.
void append_array(std::string& xml, std::string_view type, std::string_view name, int components,
                  std::string_view bytes) {
  xml += fmt::format("<DataArray type=\"{}\" Name=\"{}\" NumberOfComponents=\"{}\" format=\"binary\">", type,
                     escaped(name), components);
  xml += packed(bytes);
  xml += "</DataArray>\n";
}

void append_data(std::string& xml, std::string_view tag, const std::vector<DataArray>& arrays,
                 std::size_t entries) {
  xml += fmt::format("<{}>\n", tag);
  for (const DataArray& array : arrays) {
    if (array.size() != entries)
      throw std::logic_error(
          fmt::format("array {} has {} entries for {} of {}", array.name, array.size(), entries, tag));
    if (const auto* integers = std::get_if<std::vector<std::int64_t>>(&array.values)) {
      append_array(xml, "Int64", array.name, array.components, bytes_of(*integers));
    } else {
      const auto& reals = std::get<std::vector<double>>(array.values);
      append_array(xml, "Float32", array.name, array.components,
                   bytes_of(std::vector<float>(reals.begin(), reals.end())));
    }
  }
  xml += fmt::format("</{}>\n", tag);
}

/// Cells of one sort, each of `size` points.
void append_cells(std::string& xml, std::string_view tag, std::string_view connectivity, std::size_t n,
                  std::int64_t size) {
  std::vector<std::int64_t> offsets(n);  // where each cell ends
  for (std::size_t i = 0; i < n; ++i) offsets[i] = static_cast<std::int64_t>(i + 1) * size;
  xml += fmt::format("<{}>\n", tag);
  append_array(xml, "Int64", "connectivity", 1, connectivity);
  append_array(xml, "Int64", "offsets", 1, bytes_of(offsets));
  xml += fmt::format("</{}>\n", tag);
}

/// Data of one entry for each item, given to all cells of the item.
std::vector<DataArray> spread(const std::vector<DataArray>& data,
                              const std::vector<std::size_t>& cells_of_item) {
  std::vector<DataArray> all;
  for (const DataArray& array : data) {
    if (array.size() != cells_of_item.size())
      throw std::logic_error(fmt::format("array {} has {} entries for {} meshes", array.name, array.size(),
                                         cells_of_item.size()));
    DataArray of_cells = array;
    const auto n = static_cast<std::size_t>(array.components);
    std::visit(
        [&](auto& values) {
          const auto of_items = std::move(values);
          values.clear();
          for (std::size_t item = 0; item < cells_of_item.size(); ++item)
            for (std::size_t cell = 0; cell < cells_of_item[item]; ++cell)
              for (std::size_t k = 0; k < n; ++k) values.push_back(of_items[item * n + k]);
        },
        of_cells.values);
    all.push_back(std::move(of_cells));
  }
  return all;
}

}  // namespace

std::size_t DataArray::size() const {
  const std::size_t n = std::visit([](const auto& all) { return all.size(); }, values);
  return n / static_cast<std::size_t>(components);
}

DataArray vector_array(std::string name, std::span<const Vec3> vectors) {
  std::vector<double> values;
  values.reserve(3 * vectors.size());
  for (const Vec3& v : vectors) values.insert(values.end(), {v.x(), v.y(), v.z()});
  return {std::move(name), std::move(values), 3};
}

PolyData surfaces(std::span<const PosedMesh> meshes, const std::vector<DataArray>& data) {
  PolyData all;
  std::vector<std::size_t> triangles_of_mesh;
  for (const PosedMesh& item : meshes) {
    const auto first = static_cast<std::int64_t>(all.points.size());
    for (const Vec3& vertex : item.mesh->vertices)
      all.points.push_back(item.pose.to_world(item.scale * vertex));
    for (const auto& facet : item.mesh->facets)
      all.triangles.push_back({first + facet[0], first + facet[1], first + facet[2]});
    triangles_of_mesh.push_back(item.mesh->facets.size());
  }
  all.cell_data = spread(data, triangles_of_mesh);
  return all;
}

PolyData spheres(std::span<const Vec3> centres, std::span<const double> radii,
                 const std::vector<DataArray>& data) {
  PolyData all;
  all.points.assign(centres.begin(), centres.end());
  for (std::size_t i = 0; i < centres.size(); ++i) all.vertices.push_back(static_cast<std::int64_t>(i));
  all.point_data = data;
  all.point_data.push_back({"radius [m]", std::vector<double>(radii.begin(), radii.end())});
  return all;
}

PolyData lines_between(std::span<const Vec3> from, std::span<const Vec3> to,
                       const std::vector<DataArray>& data) {
  if (from.size() != to.size()) throw std::logic_error("lines with one end only");
  PolyData all;
  for (std::size_t i = 0; i < from.size(); ++i) {
    const auto first = static_cast<std::int64_t>(all.points.size());
    all.points.push_back(from[i]);
    all.points.push_back(to[i]);
    all.lines.push_back({first, first + 1});
  }
  all.cell_data = data;
  return all;
}

void write_vtp(const std::filesystem::path& path, const PolyData& data) {
  std::vector<float> coordinates;
  coordinates.reserve(3 * data.points.size());
  for (const Vec3& point : data.points)
    for (double x : point) coordinates.push_back(static_cast<float>(x));

  std::string xml = fmt::format(
      "<?xml version=\"1.0\"?>\n"
      "<VTKFile type=\"PolyData\" version=\"1.0\" byte_order=\"{}\" header_type=\"UInt64\" "
      "compressor=\"vtkZLibDataCompressor\">\n<PolyData>\n"
      "<Piece NumberOfPoints=\"{}\" NumberOfVerts=\"{}\" NumberOfLines=\"{}\" NumberOfStrips=\"0\" "
      "NumberOfPolys=\"{}\">\n",
      byte_order, data.points.size(), data.vertices.size(), data.lines.size(), data.triangles.size());
  append_data(xml, "PointData", data.point_data, data.points.size());
  append_data(xml, "CellData", data.cell_data, data.n_cells());
  xml += "<Points>\n";
  append_array(xml, "Float32", "Points", 3, bytes_of(coordinates));
  xml += "</Points>\n";
  append_cells(xml, "Verts", bytes_of(data.vertices), data.vertices.size(), 1);
  append_cells(xml, "Lines", bytes_of(data.lines), data.lines.size(), 2);
  append_cells(xml, "Polys", bytes_of(data.triangles), data.triangles.size(), 3);
  xml += "</Piece>\n</PolyData>\n</VTKFile>\n";
  write_file(path, xml);
}

void TimeSeries::add(double time, const std::filesystem::path& file, int part) {
  entries_.push_back({time, file.lexically_proximate(path_.parent_path()).generic_string(), part});
  write();
}

void TimeSeries::write() const {
  std::string xml = fmt::format(
      "<?xml version=\"1.0\"?>\n<VTKFile type=\"Collection\" version=\"1.0\" "
      "byte_order=\"{}\">\n<Collection>\n",
      byte_order);
  for (const Entry& entry : entries_)
    xml += fmt::format("<DataSet timestep=\"{}\" part=\"{}\" file=\"{}\"/>\n", entry.time, entry.part,
                       escaped(entry.file));
  xml += "</Collection>\n</VTKFile>\n";
  write_file(path_, xml);
}

}  // namespace trackbed
