// A whole run, from the shapes of the stones to the load, is the same bit for bit for any number of threads
// and any setting of the search.
#include <gtest/gtest.h>

#include <filesystem>

#include "lab/run.h"
#include "scenes/temporary_folder.h"

namespace trackbed {
namespace {

std::uint64_t hash_of_run(int threads, const std::vector<std::string>& more = {}) {
  std::vector<std::string> set{R"(walls.box.size=["150 mm", "150 mm", "100 mm"])",
                               R"(bodies.sleeper.size=["50 mm", "50 mm", "40 mm"])",
                               "stones.ratio=0.5",
                               "stones.distance=120 deg",
                               "stones.shapes=4",
                               "materials.ballast.kn=1e6 N/m",
                               "materials.ballast.ks=1e6 N/m",
                               "stages.pack.unbalanced_ratio=0.2",
                               "stages.rest.unbalanced_ratio=0.1",
                               "stages.before.unbalanced_ratio=0.1",
                               "stages.3.embedment=40 mm",
                               "stages.cyclic.force_max=0.8 kN",
                               "stages.cyclic.duration=0.02 s",
                               "stages.cyclic.ramp=5 ms",
                               "record.picture=false",
                               "record.tables=false",
                               "record.paraview_stones=none"};
  set.insert(set.end(), more.begin(), more.end());
  const Document document(TRACKBED_ROOT "/cases/cyclic-box/case.toml", set);
  CaseInput experiment;
  document.read(experiment);
  const TemporaryFolder folder;
  RunOptions options;
  options.out = folder.path;
  options.threads = threads;
  options.quiet = true;
  return run(document, experiment, options).state_hash;
}

TEST(run, is_the_same_for_any_number_of_threads_and_any_search) {
  const std::uint64_t one = hash_of_run(1);
  EXPECT_EQ(hash_of_run(2), one);
  EXPECT_EQ(hash_of_run(4), one);
  EXPECT_EQ(hash_of_run(1, {"numerics.skin=0.2 mm"}), one);
  EXPECT_EQ(hash_of_run(1, {"numerics.skin=1.2 mm", "numerics.margin=12 mm"}), one);
  EXPECT_NE(hash_of_run(1, {"seed=2"}), one);
}

}  // namespace
}  // namespace trackbed
