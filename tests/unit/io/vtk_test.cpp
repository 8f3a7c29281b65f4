#include "io/vtk.h"

#include <gtest/gtest.h>
#include <zlib.h>

#include <cstring>
#include <numbers>

#include "base/archive.h"
#include "base/error.h"
#include "io/files.h"
#include "scenes/temporary_folder.h"

namespace trackbed {
namespace {

namespace fs = std::filesystem;

std::string from_base64(std::string_view text) {
  constexpr std::string_view letters = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string bytes;
  std::uint32_t group = 0;
  int bits = 0;
  for (char c : text) {
    if (c == '=') break;
    group = (group << 6u) | static_cast<std::uint32_t>(letters.find(c));
    bits += 6;
    if (bits >= 8) {
      bits -= 8;
      bytes += static_cast<char>((group >> static_cast<unsigned>(bits)) & 255u);
    }
  }
  return bytes;
}

/// The values of the array after `where` in the file, decoded as the VTK file format describes it.
template <class T>
std::vector<T> array_in(const std::string& xml, std::string_view where, std::string_view name) {
  std::size_t begin = xml.find(where);
  begin = xml.find("Name=\"" + std::string(name) + "\"", begin);
  EXPECT_NE(begin, std::string::npos) << name;
  begin = xml.find('>', begin) + 1;
  const std::string_view text = std::string_view(xml).substr(begin, xml.find('<', begin) - begin);
  const auto number = [](const std::string& bytes, std::size_t i) {
    std::uint64_t value = 0;
    std::memcpy(&value, bytes.data() + 8 * i, 8);
    return value;
  };
  const std::uint64_t n_blocks = number(from_base64(text.substr(0, 32)), 0);
  const std::size_t header_bytes = 8 * (3 + n_blocks), header_letters = (header_bytes + 2) / 3 * 4;
  const std::string header = from_base64(text.substr(0, header_letters));
  const std::string packed = from_base64(text.substr(header_letters));
  std::string bytes;
  std::size_t at = 0;
  for (std::uint64_t i = 0; i < n_blocks; ++i) {
    const bool last = i + 1 == n_blocks && number(header, 2) != 0;
    std::string block(last ? number(header, 2) : number(header, 1), '\0');
    uLongf size = static_cast<uLongf>(block.size());
    EXPECT_EQ(uncompress(reinterpret_cast<Bytef*>(block.data()), &size,
                         reinterpret_cast<const Bytef*>(packed.data() + at),
                         static_cast<uLong>(number(header, 3 + i))),
              Z_OK);
    EXPECT_EQ(size, block.size());
    at += number(header, 3 + i);
    bytes += block;
  }
  EXPECT_EQ(at, packed.size());
  std::vector<T> values(bytes.size() / sizeof(T));
  if (!values.empty()) std::memcpy(values.data(), bytes.data(), values.size() * sizeof(T));
  return values;
}

class Vtk : public ::testing::Test {
 protected:
  TemporaryFolder temporary_;
  fs::path folder_ = temporary_.path;
  std::string written(const PolyData& data) {
    write_vtp(folder_ / "f.vtp", data);
    return read_file(folder_ / "f.vtp");
  }
};

const TriangleMesh tetrahedron = {{Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(0, 1, 0), Vec3(0, 0, 1)},
                                  {{{0, 2, 1}}, {{0, 1, 3}}, {{0, 3, 2}}, {{1, 2, 3}}}};

TEST_F(Vtk, PosedStones) {
  Pose turned;
  turned.position = Vec3(10, 0, 0);
  turned.orientation = Eigen::AngleAxisd(std::numbers::pi / 2, Vec3::UnitZ());
  const std::vector<PosedMesh> stones = {{&tetrahedron, {}, 1.0}, {&tetrahedron, turned, 2.0}};
  const std::string xml =
      written(surfaces(stones, {{"stone", std::vector<std::int64_t>{7, 9}},
                                {"velocity [m/s]", std::vector<double>{1, 2, 3, 4, 5, 6}, 3}}));
  EXPECT_NE(xml.find("NumberOfPoints=\"8\" NumberOfVerts=\"0\" NumberOfLines=\"0\" NumberOfStrips=\"0\" "
                     "NumberOfPolys=\"8\""),
            std::string::npos);
  const auto points = array_in<float>(xml, "<Points>", "Points");
  ASSERT_EQ(points.size(), 24u);
  EXPECT_NEAR(points[15], 10.0,
              1e-6);  // vertex (1, 0, 0) of the second stone, turned to (0, 2, 0), moved by 10
  EXPECT_NEAR(points[16], 2.0, 1e-6);
  EXPECT_NEAR(points[17], 0.0, 1e-6);
  EXPECT_EQ(
      array_in<std::int64_t>(xml, "<Polys>", "connectivity"),
      (std::vector<std::int64_t>{0, 2, 1, 0, 1, 3, 0, 3, 2, 1, 2, 3, 4, 6, 5, 4, 5, 7, 4, 7, 6, 5, 6, 7}));
  EXPECT_EQ(array_in<std::int64_t>(xml, "<Polys>", "offsets"),
            (std::vector<std::int64_t>{3, 6, 9, 12, 15, 18, 21, 24}));
  EXPECT_EQ(array_in<std::int64_t>(xml, "<CellData>", "stone"),
            (std::vector<std::int64_t>{7, 7, 7, 7, 9, 9, 9, 9}));
  const auto velocity = array_in<float>(xml, "<CellData>", "velocity [m/s]");
  ASSERT_EQ(velocity.size(), 24u);
  EXPECT_EQ(velocity[11], 3.0f);
  EXPECT_EQ(velocity[12], 4.0f);
}

TEST_F(Vtk, Spheres) {
  const std::string xml = written(
      spheres(std::vector{Vec3(1, 2, 3)}, std::vector{0.5}, {{"stone", std::vector<std::int64_t>{4}}}));
  EXPECT_EQ(array_in<float>(xml, "<Points>", "Points"), (std::vector<float>{1, 2, 3}));
  EXPECT_EQ(array_in<float>(xml, "<PointData>", "radius [m]"), std::vector<float>{0.5});
  EXPECT_EQ(array_in<std::int64_t>(xml, "<PointData>", "stone"), std::vector<std::int64_t>{4});
  EXPECT_EQ(array_in<std::int64_t>(xml, "<Verts>", "connectivity"), std::vector<std::int64_t>{0});
}

TEST_F(Vtk, ManyContactsInManyBlocks) {
  constexpr std::size_t n = 100'000;
  std::vector<Vec3> from, to;
  std::vector<double> force;
  for (std::size_t i = 0; i < n; ++i) {
    from.emplace_back(double(i), 0, 0);
    to.emplace_back(double(i), 1, 0);
    force.push_back(double(i) * 0.5);
  }
  const std::string xml =
      written(lines_between(from, to, {{"force [N]", force}, vector_array("force vector [N]", to)}));
  const auto lines = array_in<std::int64_t>(xml, "<Lines>", "connectivity");
  const auto values = array_in<float>(xml, "<CellData>", "force [N]");
  const auto vectors = array_in<float>(xml, "<CellData>", "force vector [N]");
  ASSERT_EQ(lines.size(), 2 * n);
  ASSERT_EQ(values.size(), n);
  ASSERT_EQ(vectors.size(), 3 * n);
  for (std::size_t i = 0; i < n; ++i) {
    ASSERT_EQ(lines[2 * i + 1], static_cast<std::int64_t>(2 * i + 1));
    ASSERT_EQ(values[i], static_cast<float>(force[i]));
    ASSERT_EQ(vectors[3 * i + 1], 1.0f);
  }
}

TEST_F(Vtk, NothingIsAFileToo) {
  const std::string xml = written(lines_between({}, {}, {{"force [N]", std::vector<double>()}}));
  EXPECT_TRUE(array_in<float>(xml, "<Points>", "Points").empty());
  EXPECT_TRUE(array_in<float>(xml, "<CellData>", "force [N]").empty());
}

TEST_F(Vtk, ArraysOfAnotherLengthAreRefused) {
  EXPECT_THROW(written(spheres(std::vector{Vec3(1, 2, 3)}, std::vector{0.5, 0.5}, {})), std::logic_error);
  EXPECT_THROW(written(lines_between(std::vector{Vec3(1, 2, 3)}, {}, {})), std::logic_error);
  EXPECT_THROW(surfaces({}, {{"stone", std::vector<std::int64_t>{1}}}), std::logic_error);
}

TEST_F(Vtk, TimeSeries) {
  TimeSeries series(folder_ / "stones.pvd");
  series.add(0.0, folder_ / "vtk" / "stones_0.vtp");
  series.add(0.1, folder_ / "vtk" / "stones <1>.vtp", 1);
  const std::string text = read_file(folder_ / "stones.pvd");
  EXPECT_NE(text.find("<DataSet timestep=\"0\" part=\"0\" file=\"vtk/stones_0.vtp\"/>\n"
                      "<DataSet timestep=\"0.1\" part=\"1\" file=\"vtk/stones &lt;1&gt;.vtp\"/>\n"),
            std::string::npos)
      << text;
  // Taken up again, it goes on with the entries it had.
  Archive written;
  written(series);
  TimeSeries again(folder_ / "again.pvd");
  Archive read(written.bytes());
  read(again);
  for (TimeSeries* s : {&series, &again}) s->add(0.2, folder_ / "vtk" / "stones_2.vtp");
  EXPECT_EQ(read_file(folder_ / "again.pvd"), read_file(folder_ / "stones.pvd"));
}

}  // namespace
}  // namespace trackbed
