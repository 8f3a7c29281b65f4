#include "lab/kept_bed.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <fstream>

#include "base/error.h"
#include "base/rng.h"
#include "geom/primitives.h"
#include "io/files.h"
#include "scenes/temporary_folder.h"

namespace trackbed {
namespace {

namespace fs = std::filesystem;

class KeptBed : public ::testing::Test {
 protected:
  /// Walls and bodies, without stones.
  static Simulation empty() {
    Simulation sim;
    sim.model.materials = {{"stone", 1e6, 1e6, 0.5, 0, 2630}, {"soft", 1e5, 1e5, 0.5, 0, 2000}};
    sim.model.pairs = PairTable(sim.model.materials, LawKind::linear, {});
    add_wall(sim, {make_plane_wall("floor", 1), 0, {}}, {});
    BodyProperties body;
    body.mass = 1;
    body.inertia = Vec3::Ones();
    for (const char* name : {"sleeper", "spare"}) {
      const int wall = add_wall(
          sim, {make_mesh_wall(name, box_mesh({0.1, 0.1, 0.1}, Vec3::Constant(-0.05))), 0, body}, {});
      sim.state.walls[static_cast<std::size_t>(wall)].present = false;
    }
    return sim;
  }
  static Simulation bed() {
    Simulation sim = empty();
    Rng rng(2, "bed");
    sim.model.templates.push_back(make_ball_template(0.02));
    sim.model.templates.push_back(
        make_clump_template("pear", {{{-0.01, 0, 0}, 0.02}, {{0.02, 0, 0}, 0.01}, {{0, 0.015, 0}, 0.01}},
                            4e-5, {1e-9, 2e-9, 2e-9}));
    std::vector<Pebble> pebbles;
    for (int k = 0; k < 200; ++k)
      pebbles.push_back({0.02 * (rng.rotation() * Vec3::UnitX()), rng.uniform(0.002, 0.01)});
    sim.model.templates.push_back(make_clump_template("lump", pebbles, 4e-5, {1e-9, 2e-9, 2e-9}));
    for (int s = 0; s < 30; ++s)
      add_clump(sim.model, sim.state, s % 2, rng.uniform(0.5, 2), s % 2,
                {{rng.uniform(0, 1), rng.uniform(0, 1), 0.5 + 0.1 * s}, rng.rotation()});
    sim.state.walls[1].present = true;
    sim.state.walls[1].pose = {{0.5, 0.5, 4}, rng.rotation()};
    sim.state.walls[1].applied_force = {0, 0, -380.0 / 3};
    return sim;
  }

  TemporaryFolder folder_;
  fs::path file_ = folder_.path / "stones.bed";
};

TEST_F(KeptBed, ComesBackToTheSameBits) {
  Simulation before = bed();
  write_kept_bed(before, file_);
  Simulation after = empty();
  read_kept_bed(file_, after);
  before.changed();
  after.changed();
  EXPECT_EQ(hash(after.state), hash(before.state));
  ASSERT_EQ(after.model.templates.size(), 3u);
  for (std::size_t t = 0; t < 3; ++t)  // contacts tell their pebbles by their order
    for (std::size_t k = 0; k < before.model.templates[t].pebbles.size(); ++k) {
      EXPECT_EQ(after.model.templates[t].pebbles[k].centre, before.model.templates[t].pebbles[k].centre);
      EXPECT_EQ(after.model.templates[t].pebbles[k].radius, before.model.templates[t].pebbles[k].radius);
    }
  EXPECT_TRUE(after.state.walls[1].present);
  EXPECT_EQ(after.state.walls[1].applied_force, before.state.walls[1].applied_force);
  EXPECT_FALSE(after.state.walls[2].present);
}

TEST_F(KeptBed, TakesThePlaceOfWhatWasThere) {
  Simulation sim = bed();
  write_kept_bed(sim, file_);
  sim.state.clumps = {};
  read_kept_bed(file_, sim);
  EXPECT_EQ(sim.state.clumps.size(), 30);
  EXPECT_EQ(sim.model.templates.size(), 3u);
}

TEST_F(KeptBed, PartOfAFileIsRefused) {
  Simulation kept = bed();
  write_kept_bed(kept, file_);
  const std::string whole = read_file(file_);
  for (const std::size_t size : {std::size_t{0}, whole.size() / 3, whole.size() - 4}) {
    std::ofstream(file_, std::ios::trunc) << whole.substr(0, size);
    Simulation sim = empty();
    EXPECT_THROW(read_kept_bed(file_, sim), InputError) << size;
  }
}

}  // namespace
}  // namespace trackbed
