// Surface meshes from and to files.
#pragma once

#include <filesystem>

#include "geom/mesh.h"

namespace trackbed {

/// Reads a mesh from an STL (ASCII or binary), OBJ or PLY (ASCII or binary) file, told apart by the ending
/// and the content. `unit`: length of 1 in the file [m]. Polygons become fans of
/// triangles; vertices of an STL file that agree in every bit are merged. Nothing else is changed or checked:
/// that is make_solid's part. Throws InputError naming the file (and the line, of text) when it cannot be
/// read.
TriangleMesh read_mesh(const std::filesystem::path& path, double unit = 1);

/// Writes a binary STL file. Throws InputError when the file cannot be written.
void write_stl(const TriangleMesh& mesh, const std::filesystem::path& path);

}  // namespace trackbed
