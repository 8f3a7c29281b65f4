#include "geom/mesh_io.h"

#include <gtest/gtest.h>

#include <cstdint>
#include <fstream>

#include "base/error.h"
#include "geom/mass_properties.h"
#include "scenes/temporary_folder.h"
#include "shapes.h"

namespace trackbed {
namespace {

class MeshIo : public ::testing::Test {
 protected:
  std::filesystem::path file(const std::string& name) const { return folder_.path / name; }
  std::filesystem::path with(const std::string& name, const std::string& text) const {
    std::ofstream(file(name), std::ios::binary) << text;
    return file(name);
  }
  TemporaryFolder folder_;
  static std::string contents(const std::filesystem::path& path) {
    std::ifstream in(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(in), {}};
  }
  static std::string complaint(const std::filesystem::path& path) {
    try {
      read_mesh(path);
    } catch (const InputError& error) {
      return error.what();
    }
    return "";
  }
};

const std::string tetrahedron_obj =
    "mtllib a.mtl\nv 0 0 0 0.5 0.5 0.5\nv 1 0 0 1 1 1\nvn 0 0 1\nv 0 1 0\nv 0 0 1e0 # top\n"
    "f 1//1 3//1 2//1\nf 1/1/1 2/1/1 4/1/1\nf 1 4 3\nf -3 -2 -1\n";

void expect_tetrahedron(const TriangleMesh& mesh) {
  EXPECT_EQ(mesh.vertices.size(), 4u);
  EXPECT_EQ(mesh.facets.size(), 4u);
  EXPECT_NEAR(mass_properties(mesh).volume, 1.0 / 6, 1e-15);
}

std::string ply(const std::string& format) {
  return "ply\nformat " + format +
         " 1.0\ncomment made by hand\nelement vertex 4\nproperty float x\nproperty float y\nproperty float "
         "z\n"
         "property uchar red\nelement face 4\nproperty list uchar int vertex_indices\nend_header\n";
}

template <class T>
void put(std::string& bytes, T value, bool big) {
  std::string part(reinterpret_cast<const char*>(&value), sizeof(T));
  bytes += big ? std::string(part.rbegin(), part.rend()) : part;
}

std::string binary_ply(bool big) {
  std::string bytes = ply(big ? "binary_big_endian" : "binary_little_endian");
  const float points[4][3] = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  for (const auto& p : points) {
    for (float x : p) put(bytes, x, big);
    bytes += '\x80';
  }
  const std::int32_t facets[4][3] = {{0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {1, 2, 3}};
  for (const auto& f : facets) {
    bytes += '\3';
    for (std::int32_t k : f) put(bytes, k, big);
  }
  return bytes;
}

TEST_F(MeshIo, obj_with_colours_normals_comments_and_negative_indices) {
  expect_tetrahedron(read_mesh(with("a.obj", tetrahedron_obj)));
}

TEST_F(MeshIo, ending_may_be_in_capitals_and_lines_end_as_on_windows) {
  std::string text;
  for (char c : tetrahedron_obj) text += c == '\n' ? std::string("\r\n") : std::string(1, c);
  expect_tetrahedron(read_mesh(with("A.OBJ", text)));
}

TEST_F(MeshIo, ply_as_text) {
  expect_tetrahedron(read_mesh(with("a.ply", ply("ascii") + "0 0 0 9\n1 0 0 9\n0 1 0 9\n0 0 1 9\n"
                                                            "3 0 2 1\n3 0 1 3\n3 0 3 2\n3 1 2 3\n")));
}

TEST_F(MeshIo, ply_as_binary_in_both_byte_orders) {
  expect_tetrahedron(read_mesh(with("a.ply", binary_ply(false))));
  expect_tetrahedron(read_mesh(with("b.ply", binary_ply(true))));
}

TEST_F(MeshIo, polygons_become_triangles) {
  const TriangleMesh mesh =
      read_mesh(with("a.obj",
                     "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 0 0 1\nv 1 0 1\nv 1 1 1\nv 0 1 1\n"
                     "f 4 3 2 1\nf 5 6 7 8\nf 1 2 6 5\nf 2 3 7 6\nf 3 4 8 7\nf 4 1 5 8\n"));
  EXPECT_EQ(mesh.facets.size(), 12u);
  EXPECT_NEAR(mass_properties(mesh).volume, 1, 1e-15);
}

TEST_F(MeshIo, stl_written_and_read_back) {
  const TriangleMesh box = testing::box_mesh({1, 2, 3}, {-1, 0, 5});
  write_stl(box, file("a.stl"));
  const TriangleMesh back = read_mesh(file("a.stl"));
  EXPECT_EQ(back.vertices.size(), 8u);
  ASSERT_EQ(back.facets.size(), 12u);
  for (std::size_t f = 0; f < 12; ++f) EXPECT_EQ(back.corners(f), box.corners(f));
}

TEST_F(MeshIo, binary_stl_that_begins_with_solid) {
  write_stl(testing::box_mesh(Vec3::Ones()), file("a.stl"));
  std::string bytes = contents(file("a.stl"));
  bytes.replace(0, 11, "solid stone");
  EXPECT_EQ(read_mesh(with("b.stl", bytes)).facets.size(), 12u);
}

TEST_F(MeshIo, stl_as_text) {
  const std::string facet =
      " facet normal 0 0 1\n  outer loop\n   vertex 0 0 0\n   vertex 1 0 -0.0\n   vertex 0 1 +1e-1\n"
      "  endloop\n endfacet\n";
  const TriangleMesh mesh = read_mesh(with("a.stl", "solid stone\n" + facet + facet + "endsolid stone\n"));
  EXPECT_EQ(mesh.vertices.size(), 3u);
  EXPECT_EQ(mesh.facets.size(), 2u);
  EXPECT_NE(complaint(with("b.stl", "solid stone\n" + facet)).find("cut off"), std::string::npos);
}

TEST_F(MeshIo, says_what_is_wrong_with_a_file) {
  const auto says = [&](const std::string& name, const std::string& text, const std::string& part) {
    const std::string message = complaint(with(name, text));
    EXPECT_NE(message.find(part), std::string::npos) << name << " says: " << message;
    EXPECT_NE(message.find(name), std::string::npos) << message;
  };
  EXPECT_NE(complaint(file("missing.stl")).find("no such file"), std::string::npos);
  says("a.vtk", "x", "ending");
  says("a.obj", "v 0 0 0\n", "no facets");
  says("b.obj", "", "no facets");
  says("c.obj", "v 0 0 nan\n", "not finite");
  says("d.obj", "v 0 0 1x\n", "line 1: \"1x\" is not a number");
  says("e.obj", "v 0 0 0\nv 1 0 0\nf 1 2\n", "2 corners");
  says("f.obj", "v 0 0 0\nf 1 2 3\n", "cut off");
  says("g.obj", "v 0 0 0\nf 1 -2 1\n", "no vertex -2");
  says("h.obj", "v 0 0 1e999\n", "not a number");
  says("i.obj", "v 0 0 0\nf 99999999999 1 1\n", "beyond");
  says("a.stl", "short", "cut off");
  says("a.ply", "plx\n", "begins with");
  says("b.ply", ply("ascii"), "cut off");
  says("c.ply", "ply\nformat ascii 1.0\nelement vertex 4000000000\n", "announces 4000000000");
  says("d.ply", binary_ply(false).substr(0, 300), "cut off");
  says("e.ply", ply("ascii").substr(0, 60), "");
}

TEST_F(MeshIo, corrupt_count_of_a_binary_stl_is_refused_without_memory) {
  write_stl(testing::box_mesh(Vec3::Ones()), file("a.stl"));
  std::string bytes = contents(file("a.stl"));
  for (std::size_t k = 80; k < 84; ++k) bytes[k] = '\xff';
  EXPECT_NE(complaint(with("b.stl", bytes)).find("announces 4294967295"), std::string::npos);
  EXPECT_NE(complaint(with("c.stl", contents(file("a.stl")).substr(0, 300))).find("cut off"),
            std::string::npos);
}

TEST_F(MeshIo, any_cut_or_flipped_byte_is_read_or_refused) {
  const std::string whole = binary_ply(false);
  for (std::size_t size = 0; size < whole.size(); ++size)
    EXPECT_FALSE(complaint(with("a.ply", whole.substr(0, size))).empty()) << size;
  for (std::size_t at = 0; at < whole.size(); ++at) {
    std::string bent = whole;
    bent[at] = static_cast<char>(bent[at] ^ 0xff);
    complaint(with("b.ply", bent));  // any other exception ends the test
  }
}

}  // namespace
}  // namespace trackbed
