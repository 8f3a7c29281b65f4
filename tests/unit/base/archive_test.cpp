#include "base/archive.h"

#include <gtest/gtest.h>

#include <cmath>

namespace trackbed {
namespace {

struct Part {
  int number = 0;
  std::optional<double> maybe;
  std::vector<std::string> words;

  template <class A>
  void archive(A& a) {
    a(number, maybe, words);
  }
};

TEST(Archive, ReadsBackToTheSameBits) {
  std::vector<Part> parts{{1, std::nullopt, {}}, {2, -0.0, {"", "two words"}}};
  std::map<int, Vec3> places{{3, {1, 2, 3}}, {-1, {0.1, 0.2, 0.3}}};
  Eigen::AlignedBox3d empty;
  Pose pose{{1, 2, 3}, Quat(0.5, 0.5, -0.5, 0.5)};
  bool truth = true;
  Archive out;
  out(parts, places, empty, pose, truth);

  std::vector<Part> parts2{{7, 7.0, {"old"}}};
  std::map<int, Vec3> places2{{9, {}}};
  Eigen::AlignedBox3d box(Vec3::Zero(), Vec3::Ones());
  Pose pose2;
  bool truth2 = false;
  Archive in(out.bytes());
  in(parts2, places2, box, pose2, truth2);
  ASSERT_EQ(parts2.size(), 2u);
  EXPECT_EQ(parts2[0].maybe, std::nullopt);
  EXPECT_TRUE(parts2[1].maybe && std::signbit(*parts2[1].maybe));
  EXPECT_EQ(parts2[1].words, parts[1].words);
  EXPECT_EQ(places2, places);
  EXPECT_TRUE(box.isEmpty());
  EXPECT_EQ(pose2.orientation.coeffs(), pose.orientation.coeffs());
  EXPECT_TRUE(truth2);
  EXPECT_THROW(in(truth2), RunError);
}

TEST(Archive, RefusesWhatEndsTooEarly) {
  std::vector<double> values(10, 1.5);
  std::string text = "text";
  Archive out;
  out(values, text);
  for (std::size_t size = 0; size < out.bytes().size(); ++size) {
    Archive in(out.bytes().substr(0, size));
    EXPECT_THROW(in(values, text), RunError) << size;
  }
}

}  // namespace
}  // namespace trackbed
