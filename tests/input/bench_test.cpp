// What is said to names of bench scenes that are none; that the program then exits with 2 is tested by ctest.
#include <gtest/gtest.h>

#include "base/error.h"
#include "lab/bench_scenes.h"

namespace trackbed {
namespace {

TEST(BenchNames, UnknownOneIsToldTheNearest) {
  EXPECT_EQ(find_bench_scene("box-270").name, "box-270");
  try {
    find_bench_scene("ball-100k");
    FAIL() << "ball-100k was found";
  } catch (const InputError& error) {
    EXPECT_TRUE(std::string(error.what())
                    .starts_with("there is no bench scene called ball-100k: did you mean balls-100k?"))
        << error.what();
  }
}

}  // namespace
}  // namespace trackbed
