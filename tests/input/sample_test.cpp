#include "../unit/io/sample_input.h"
#include "bad_files.h"

namespace trackbed {
namespace {

TEST(BadFiles, Sample) {
  expect_messages<sample::Case>(std::filesystem::path(TRACKBED_ROOT) / "tests/input/sample");
}

}  // namespace
}  // namespace trackbed
