#include "io/picture.h"

#include <gtest/gtest.h>
#include <png.h>

#include <algorithm>
#include <numbers>

#include "base/error.h"
#include "geom/primitives.h"
#include "scenes/temporary_folder.h"

namespace trackbed {
namespace {

const Colour red{1, 0, 0}, blue{0, 0, 1}, green{0, 1, 0};
const Eigen::AlignedBox3d unit_box(Vec3::Constant(-1), Vec3::Constant(1));

bool is_white(const Picture& picture, int x, int y) {
  return picture.pixel(x, y) == std::array<std::uint8_t, 3>{255, 255, 255};
}

/// Which of the three colours a pixel has: 0 red, 1 green, 2 blue; -1 white.
int hue(const Picture& picture, int x, int y) {
  if (is_white(picture, x, y)) return -1;
  const auto rgb = picture.pixel(x, y);
  return static_cast<int>(std::max_element(rgb.begin(), rgb.end()) - rgb.begin());
}

Picture along_y() {
  Picture picture(100, 100);
  picture.look(Vec3::UnitY(), unit_box);
  return picture;
}

TEST(picture, sphere_covers_its_disc) {
  Picture picture = along_y();
  picture.draw_sphere(Vec3::Zero(), 0.5, red);
  int covered = 0;
  for (int y = 0; y < 100; ++y)
    for (int x = 0; x < 100; ++x) covered += !is_white(picture, x, y);
  const double radius = 0.94 * 25;  // pixels
  EXPECT_NEAR(covered, std::numbers::pi * radius * radius, 0.06 * covered);
  EXPECT_EQ(hue(picture, 50, 50), 0);
  EXPECT_TRUE(is_white(picture, 2, 2));
}

TEST(picture, z_is_up_and_x_is_right_seen_along_y) {
  Picture picture = along_y();
  picture.draw_sphere({0.7, 0, 0.7}, 0.2, red);
  picture.draw_sphere({-0.7, 0, 0}, 0.2, blue);
  EXPECT_EQ(hue(picture, 83, 17), 0);
  EXPECT_EQ(hue(picture, 17, 50), 2);
}

TEST(picture, nearer_things_hide_farther_ones_whatever_the_order) {
  for (bool far_first : {true, false}) {
    Picture picture = along_y();
    if (far_first) picture.draw_sphere({0, 0.5, 0}, 0.3, blue);
    picture.draw_sphere({0, -0.5, 0}, 0.2, red);
    if (!far_first) picture.draw_sphere({0, 0.5, 0}, 0.3, blue);
    EXPECT_EQ(hue(picture, 50, 50), 0);
    EXPECT_EQ(hue(picture, 62, 50), 2);
  }
}

TEST(picture, mesh_in_its_pose_and_scale) {
  Picture picture = along_y();
  Pose pose;
  pose.position = {0.5, 0, 0};
  picture.draw_mesh(box_mesh(Vec3::Ones(), Vec3::Constant(-0.5)), pose, 0.5, green);
  EXPECT_EQ(hue(picture, 73, 50), 1);
  EXPECT_EQ(hue(picture, 63, 50), 1);
  EXPECT_TRUE(is_white(picture, 58, 50));
  EXPECT_TRUE(is_white(picture, 90, 50));
}

TEST(picture, cylinder_is_its_radius_wide) {
  Picture picture = along_y();
  picture.draw_cylinder({0, -0.3, -0.5}, {0, 0.3, 0.5}, 0.1, blue);
  for (int y : {30, 50, 70}) {
    int width = 0;
    for (int x = 0; x < 100; ++x) width += !is_white(picture, x, y);
    EXPECT_NEAR(width, 0.94 * 10, 1.1);
  }
}

TEST(picture, draws_only_into_its_part) {
  Picture picture(100, 50);
  picture.look(Vec3::UnitY(), unit_box, {0.5, 0, 0.5, 1});
  picture.draw_sphere(Vec3::Zero(), 30, red);
  EXPECT_TRUE(is_white(picture, 49, 25));
  EXPECT_EQ(hue(picture, 50, 25), 0);
}

TEST(picture, upper_sides_are_brighter) {
  Picture picture = along_y();
  picture.draw_sphere(Vec3::Zero(), 0.9, red);
  EXPECT_GT(picture.pixel(50, 20)[0], picture.pixel(50, 80)[0] + 50);
}

TEST(picture, file_reads_back) {
  const TemporaryFolder folder;
  const auto path = folder.path / "picture.png";
  Picture picture(64, 48);
  picture.draw_sphere(Vec3::Zero(), 0.5, red);
  picture.write_png(path);
  png_image image{};
  image.version = PNG_IMAGE_VERSION;
  ASSERT_TRUE(png_image_begin_read_from_file(&image, path.c_str()));
  EXPECT_EQ(image.width, 64u);
  EXPECT_EQ(image.height, 48u);
  image.format = PNG_FORMAT_RGB;
  std::vector<std::uint8_t> bytes(PNG_IMAGE_SIZE(image));
  ASSERT_TRUE(png_image_finish_read(&image, nullptr, bytes.data(), 0, nullptr));
  for (std::size_t k = 0; k < 3; ++k) EXPECT_EQ(bytes[(24 * 64 + 32) * 3 + k], picture.pixel(32, 24)[k]);
  EXPECT_THROW(picture.write_png("/no/such/folder/a.png"), InputError);
}

}  // namespace
}  // namespace trackbed
