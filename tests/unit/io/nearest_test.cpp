#include "io/nearest.h"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

namespace trackbed {
namespace {

TEST(Nearest, EditDistance) {
  EXPECT_EQ(edit_distance("friction", "friction"), 0u);
  EXPECT_EQ(edit_distance("frictoin", "friction"), 1u);  // swapped neighbours
  EXPECT_EQ(edit_distance("kitten", "sitting"), 3u);
  EXPECT_EQ(edit_distance("", "abc"), 3u);
}

TEST(Nearest, AsksOnlyWhenItIsNear) {
  EXPECT_EQ(known_words("setle", {"load", "settle"}), "did you mean settle? known here: settle, load");
  EXPECT_EQ(known_words("hertzian", {"linear", "hertz"}), "did you mean hertz? known here: hertz, linear");
  EXPECT_EQ(known_words("xyz", {"load", "settle"}), "known here: load, settle");
  EXPECT_EQ(known_words("x", {}), "nothing is allowed here");
  EXPECT_EQ(known_words("setle", {"load", "settle", "repeat"}, 2),
            "did you mean settle? known here: settle, load");
  EXPECT_EQ(known_words(std::string(100'000, 'l'), {"load"}), "known here: load");
}

RC_GTEST_PROP(Nearest, DistanceIsSymmetric, (const std::string& a, const std::string& b)) {
  RC_ASSERT(edit_distance(a, b) == edit_distance(b, a));
  RC_ASSERT(edit_distance(a, b) <= std::max(a.size(), b.size()));
}

}  // namespace
}  // namespace trackbed
