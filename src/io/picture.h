// Pictures of stones, beds and forces: a small renderer in software, to a PNG file.
#pragma once

#include <Eigen/Geometry>
#include <array>
#include <cstdint>
#include <filesystem>
#include <vector>

#include "base/vec.h"
#include "geom/mesh.h"

namespace trackbed {

struct Colour {
  float red, green, blue;  // 0 to 1
};

/// A part of a picture, in shares of its width and height from the upper left corner.
struct Viewport {
  double left = 0, top = 0, width = 1, height = 1;
};

/// A white picture into which solids are drawn, nearest in front, lit softly from above the viewer's left
/// shoulder. The projection is parallel: equal lengths look equal everywhere. Edges are smoothed by drawing
/// at twice the size.
class Picture {
 public:
  Picture(int width, int height);  ///< pixels

  /// From now on draws into a part of the picture, looking along a direction, so that the box just fits. z
  /// points up.
  void look(const Vec3& direction, const Eigen::AlignedBox3d& box, const Viewport& part = {});

  void draw_mesh(const TriangleMesh& mesh, const Pose& pose, double scale, const Colour& colour);
  void draw_sphere(const Vec3& centre, double radius, const Colour& colour);
  void draw_cylinder(const Vec3& from, const Vec3& to, double radius, const Colour& colour);  ///< round ends

  /// Red, green and blue of a finished pixel, 0 to 255.
  std::array<std::uint8_t, 3> pixel(int x, int y) const;

  /// Throws InputError when the file cannot be written.
  void write_png(const std::filesystem::path& path) const;

 private:
  static constexpr int fine = 2;  // drawn pixels per pixel of the file, each way

  struct PixelBox {
    int left, top, right, bottom;  // right and bottom are outside
  };
  Vec3 to_screen(
      const Vec3& point) const;  // x right, y down [drawn pixels]; z towards the viewer, same scale
  PixelBox pixels_around(const Vec3& low, const Vec3& high) const;
  void put(int x, int y, double depth, const Vec3& normal, const Colour& colour);
  void draw_triangle(const Vec3& a, const Vec3& b, const Vec3& c, const Colour& colour);

  int width_, height_;  // drawn pixels
  std::vector<Colour> colours_;
  std::vector<float> depths_;
  Mat3 to_view_ = Mat3::Identity();  // rows: right, down, towards the viewer
  Vec3 centre_ = Vec3::Zero();       // lands in the middle of the part
  double scale_ = 1;                 // drawn pixels per metre
  double middle_x_ = 0, middle_y_ = 0;
  PixelBox part_{};
};

}  // namespace trackbed
