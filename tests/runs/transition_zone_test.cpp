// The transition zone in a short form.
#include <gtest/gtest.h>

#include "expected.h"
#include "scenes/temporary_folder.h"

namespace trackbed {
namespace {

TEST(transition_zone, short_form_gives_what_the_case_expects) {
  const TemporaryFolder folder;
  run_and_compare("transition-zone", folder.path);
}

}  // namespace
}  // namespace trackbed
