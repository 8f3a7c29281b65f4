// Beds that came from another code as lists of spheres.
#include "lab/bed_file.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>
#include <vector>

#include "base/error.h"
#include "base/rng.h"
#include "scenes/temporary_folder.h"

namespace trackbed {
namespace {

namespace fs = std::filesystem;

class BedFile : public ::testing::Test {
 protected:
  TemporaryFolder folder_;
  fs::path file_ = folder_.path / "bed.txt";
};

/// Places of a stone's pebbles [m].
std::vector<Vec3> places(const Simulation& sim, std::size_t stone) {
  const Clumps& c = sim.state.clumps;
  std::vector<Vec3> all;
  for (const Pebble& p : sim.model.templates[static_cast<std::size_t>(c.shape[stone])].pebbles)
    all.emplace_back(c.position[stone] + c.orientation[stone] * (c.scale[stone] * p.centre));
  return all;
}

TEST_F(BedFile, EqualStonesShareATemplateAndStandWhereTheyStood) {
  const std::vector<Pebble> stone{
      {{0, 0, 0}, 0.02}, {{0.015, 0, 0}, 0.012}, {{-0.012, 0.006, 0}, 0.011}, {{0, -0.01, 0.008}, 0.013}};
  Rng rng(1, "poses");
  std::vector<Pose> poses;
  std::ofstream out(file_);
  for (int s = 0; s < 20; ++s) {
    poses.push_back({{0.1 + 0.1 * s, rng.uniform(0.1, 3), rng.uniform(0.1, 3)}, rng.rotation()});
    for (const Pebble& p : stone) {
      const Vec3 at = poses.back().to_world(p.centre);
      out << fmt::format("{} {} {} {} {}\n", at.x(), at.y(), at.z(), p.radius, s);
    }
  }
  out.close();
  const Simulation sim = read_bed(file_, 4, 2630);
  ASSERT_EQ(sim.state.clumps.size(), 20);
  ASSERT_EQ(sim.model.templates.size(), 1u);
  const ClumpTemplate& shape = sim.model.templates[0];
  for (std::size_t s = 0; s < poses.size(); ++s) {
    const std::vector<Vec3> found = places(sim, s);
    for (std::size_t k = 0; k < found.size(); ++k) {
      // Pebbles stand in another order; radii tell which is which.
      const auto given = std::ranges::find(stone, shape.pebbles[k].radius, &Pebble::radius);
      ASSERT_NE(given, stone.end());
      EXPECT_LT((found[k] - poses[s].to_world(given->centre)).norm(), 1e-14);
    }
  }
}

// A ball, then clumps of equal radii, of which the third is another shape.
TEST_F(BedFile, BallsAndUnequalClumpsHaveTemplatesOfTheirOwn) {
  std::ofstream(file_) << "0.1 0.1 0.1 0.02 0\n"
                          "0.3 0.1 0.1 0.02 1\n0.32 0.1 0.1 0.01 1\n"
                          "0.5 0.1 0.1 0.02 2\n0.5 0.12 0.1 0.01 2\n"
                          "0.7 0.1 0.1 0.02 3\n0.715 0.1 0.1 0.01 3\n"
                          "0.9 0.1 0.1 0.03 4\n";
  const Simulation sim = read_bed(file_, 2, 2630);
  ASSERT_EQ(sim.state.clumps.size(), 5);
  EXPECT_EQ(sim.state.clumps.shape, (std::vector<int>{0, 1, 1, 2, 0}));
  const std::vector<std::vector<Vec3>> given{{{0.1, 0.1, 0.1}},
                                             {{0.3, 0.1, 0.1}, {0.32, 0.1, 0.1}},
                                             {{0.5, 0.1, 0.1}, {0.5, 0.12, 0.1}},
                                             {{0.7, 0.1, 0.1}, {0.715, 0.1, 0.1}},
                                             {{0.9, 0.1, 0.1}}};
  for (std::size_t s = 0; s < given.size(); ++s) {
    const std::vector<Vec3> found = places(sim, s);
    ASSERT_EQ(found.size(), given[s].size());
    for (const Vec3& at : given[s]) {
      const auto distance = [&](const Vec3& x) { return (x - at).norm(); };
      EXPECT_LT(distance(*std::ranges::min_element(found, {}, distance)), 1e-12);
    }
  }
}

TEST_F(BedFile, SpheresWithoutANumberAreBalls) {
  std::ofstream(file_) << "# x y z r\n0.1 0.1 0.05 0.02\n\n0.2 0.1 0.05 0.03 # larger\n";
  const Simulation sim = read_bed(file_, 0.6, 1000);
  ASSERT_EQ(sim.state.clumps.size(), 2);
  EXPECT_EQ(sim.model.templates.size(), 1u);
  EXPECT_DOUBLE_EQ(sim.state.clumps.mass[1] / sim.state.clumps.mass[0], 27.0 / 8.0);
}

TEST_F(BedFile, TellsTheLineThatIsWrong) {
  std::ofstream(file_) << "0.1 0.1 0.05 0.02\n0.1 0.1 0.02\n";
  try {
    read_bed(file_, 0.6, 2630);
    FAIL() << "three numbers were taken for a sphere";
  } catch (const InputError& error) {
    EXPECT_EQ(error.what(), file_.string() + ":2: 3 numbers; a line is x y z r [clump]");
  }
}

}  // namespace
}  // namespace trackbed
