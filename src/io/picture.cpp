#include "io/picture.h"

#include <png.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "base/error.h"

namespace trackbed {
namespace {

/// Share of its colour that a surface shows, for its normal in the viewer's axes (right, down, towards).
float brightness(const Vec3& normal) {
  static const Vec3 lamp = Vec3(-0.45, -0.75, 0.65).normalized();
  const double sky = 0.5 - 0.5 * normal.y();  // surfaces that look up get more of the even light
  return static_cast<float>(std::min(1.0, 0.27 + 0.18 * sky + 0.53 * std::max(0.0, normal.dot(lamp))));
}

}  // namespace

Picture::Picture(int width, int height)
    : width_(fine * width),
      height_(fine * height),
      colours_(static_cast<std::size_t>(width_) * static_cast<std::size_t>(height_), Colour{1, 1, 1}),
      depths_(colours_.size(), -std::numeric_limits<float>::infinity()) {
  look(-Vec3::UnitY(), Eigen::AlignedBox3d(Vec3::Constant(-1), Vec3::Constant(1)));
}

void Picture::look(const Vec3& direction, const Eigen::AlignedBox3d& box, const Viewport& part) {
  const Vec3 towards = -direction.normalized();
  const Vec3 up = std::abs(towards.z()) < 0.999 ? Vec3::UnitZ() : Vec3::UnitY();
  const Vec3 right = up.cross(towards).normalized();
  to_view_ << right.transpose(), -towards.cross(right).transpose(), towards.transpose();
  centre_ = box.center();
  const auto pixels = [](double share, int size) { return static_cast<int>(std::lround(share * size)); };
  part_ = {pixels(part.left, width_), pixels(part.top, height_), pixels(part.left + part.width, width_),
           pixels(part.top + part.height, height_)};
  middle_x_ = (part_.left + part_.right) / 2.0;
  middle_y_ = (part_.top + part_.bottom) / 2.0;
  const Vec3 extent = to_view_.cwiseAbs() * box.sizes();
  constexpr double margin = 0.94;
  scale_ =
      margin * std::min((part_.right - part_.left) / extent.x(), (part_.bottom - part_.top) / extent.y());
}

Vec3 Picture::to_screen(const Vec3& point) const {
  return scale_ * (to_view_ * (point - centre_)) + Vec3(middle_x_, middle_y_, 0);
}

Picture::PixelBox Picture::pixels_around(const Vec3& low, const Vec3& high) const {
  const auto within = [](double x, int from, int to) {
    return static_cast<int>(std::clamp<double>(x, from, to));
  };
  return {within(std::floor(low.x()), part_.left, part_.right),
          within(std::floor(low.y()), part_.top, part_.bottom),
          within(std::ceil(high.x()) + 1, part_.left, part_.right),
          within(std::ceil(high.y()) + 1, part_.top, part_.bottom)};
}

void Picture::put(int x, int y, double depth, const Vec3& normal, const Colour& colour) {
  const std::size_t k =
      static_cast<std::size_t>(y) * static_cast<std::size_t>(width_) + static_cast<std::size_t>(x);
  if (static_cast<float>(depth) <= depths_[k]) return;
  depths_[k] = static_cast<float>(depth);
  const float b = brightness(normal);
  colours_[k] = {b * colour.red, b * colour.green, b * colour.blue};
}

void Picture::draw_triangle(const Vec3& a, const Vec3& b, const Vec3& c, const Colour& colour) {
  Vec3 normal = (b - a).cross(c - a);
  const double twice_area = normal.z();
  if (twice_area == 0) return;  // seen edge-on
  normal *= (normal.z() > 0 ? 1 : -1) / normal.norm();
  const PixelBox box = pixels_around(a.cwiseMin(b).cwiseMin(c), a.cwiseMax(b).cwiseMax(c));
  for (int y = box.top; y < box.bottom; ++y) {
    for (int x = box.left; x < box.right; ++x) {
      const double px = x + 0.5, py = y + 0.5;
      const double u = ((c.x() - b.x()) * (py - b.y()) - (c.y() - b.y()) * (px - b.x())) / twice_area;
      const double v = ((a.x() - c.x()) * (py - c.y()) - (a.y() - c.y()) * (px - c.x())) / twice_area;
      if (u < 0 || v < 0 || u + v > 1) continue;
      put(x, y, u * a.z() + v * b.z() + (1 - u - v) * c.z(), normal, colour);
    }
  }
}

void Picture::draw_mesh(const TriangleMesh& mesh, const Pose& pose, double scale, const Colour& colour) {
  std::vector<Vec3> places;
  for (const Vec3& v : mesh.vertices) places.push_back(to_screen(pose.to_world(scale * v)));
  for (const auto& f : mesh.facets)
    draw_triangle(places[static_cast<std::size_t>(f[0])], places[static_cast<std::size_t>(f[1])],
                  places[static_cast<std::size_t>(f[2])], colour);
}

void Picture::draw_sphere(const Vec3& centre, double radius, const Colour& colour) {
  const Vec3 c = to_screen(centre);
  const double r = scale_ * radius;
  const PixelBox box = pixels_around(c - Vec3::Constant(r), c + Vec3::Constant(r));
  for (int y = box.top; y < box.bottom; ++y) {
    for (int x = box.left; x < box.right; ++x) {
      const double dx = x + 0.5 - c.x(), dy = y + 0.5 - c.y(), dz2 = r * r - dx * dx - dy * dy;
      if (dz2 < 0) continue;
      const double dz = std::sqrt(dz2);
      put(x, y, c.z() + dz, Vec3(dx, dy, dz) / r, colour);
    }
  }
}

void Picture::draw_cylinder(const Vec3& from, const Vec3& to, double radius, const Colour& colour) {
  draw_sphere(from, radius, colour);
  draw_sphere(to, radius, colour);
  const Vec3 a = to_screen(from), b = to_screen(to);
  const double r = scale_ * radius, length = (b - a).norm();
  if (length == 0) return;
  const Vec3 axis = (b - a) / length;
  const double slope = 1 - axis.z() * axis.z();
  if (slope < 1e-9) return;  // seen end-on: the round end covers it
  const PixelBox box = pixels_around(a.cwiseMin(b) - Vec3::Constant(r), a.cwiseMax(b) + Vec3::Constant(r));
  for (int y = box.top; y < box.bottom; ++y) {
    for (int x = box.left; x < box.right; ++x) {
      // Height z of the line of sight at which its distance from the axis is r, the nearer of the two.
      const Vec3 d(x + 0.5 - a.x(), y + 0.5 - a.y(), 0);
      const double along = d.dot(axis), half = -along * axis.z();
      const double root = half * half - slope * (d.squaredNorm() - along * along - r * r);
      if (root < 0) continue;
      const double z = (-half + std::sqrt(root)) / slope;
      const double place = along + z * axis.z();
      if (place < 0 || place > length) continue;
      put(x, y, a.z() + z, (d + z * Vec3::UnitZ() - place * axis) / r, colour);
    }
  }
}

std::array<std::uint8_t, 3> Picture::pixel(int x, int y) const {
  float red = 0, green = 0, blue = 0;
  for (int dy = 0; dy < fine; ++dy) {
    for (int dx = 0; dx < fine; ++dx) {
      const Colour& c = colours_[static_cast<std::size_t>(fine * y + dy) * static_cast<std::size_t>(width_) +
                                 static_cast<std::size_t>(fine * x + dx)];
      red += c.red, green += c.green, blue += c.blue;
    }
  }
  const auto byte = [](float sum) {
    return static_cast<std::uint8_t>(std::lround(255 * std::min(1.0f, sum / (fine * fine))));
  };
  return {byte(red), byte(green), byte(blue)};
}

void Picture::write_png(const std::filesystem::path& path) const {
  std::vector<std::uint8_t> bytes;
  for (int y = 0; y < height_ / fine; ++y)
    for (int x = 0; x < width_ / fine; ++x)
      for (std::uint8_t byte : pixel(x, y)) bytes.push_back(byte);
  png_image image{};
  image.version = PNG_IMAGE_VERSION;
  image.width = static_cast<png_uint_32>(width_ / fine);
  image.height = static_cast<png_uint_32>(height_ / fine);
  image.format = PNG_FORMAT_RGB;
  if (!png_image_write_to_file(&image, path.c_str(), 0, bytes.data(), 0, nullptr))
    throw InputError(path.string() + ": the picture cannot be written (" + image.message + ")");
}

}  // namespace trackbed
