// The cyclic box test in a short form: few, coarse and soft stones, half a cycle.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "expected.h"
#include "io/files.h"

namespace trackbed {
namespace {

namespace fs = std::filesystem;

const fs::path out = fs::temp_directory_path() / "trackbed-cyclic-box";

/// One run for all tests of this file.
const Summary& summary() {
  static const Summary made = run_and_compare("cyclic-box", out);
  return made;
}

TEST(CyclicBox, MeasuresAreAsExpected) {
  EXPECT_EQ(summary().stages.size(), 7u);
}

TEST(CyclicBox, BoxCarriesStonesSleeperAndLoad) {
  const StageSummary& rest = stage_of(summary(), "before");
  double carried = 0;
  for (const char* side : {"floor", "left", "right", "front", "back"})
    carried -= value_of(rest.measures, std::string("box.") + side + ".force_z");
  const double load = 380;  // [N]
  const double all = value_of(rest.measures, "weight") + load;
  EXPECT_NEAR(carried, all, 1e-3 * all);
}

TEST(CyclicBox, NoStoneIsLost) {
  const double added = value_of(stage_of(summary(), "fill").results, "added");
  const double removed = value_of(stage_of(summary(), "insert").results, "removed");
  EXPECT_GT(added, 100);
  EXPECT_EQ(value_of(summary().measures, "stones"), added - removed);
  const std::string table = read_file(out / "stones.csv");
  EXPECT_EQ(std::ranges::count(table, '\n'), std::lround(added - removed) + 1);  // and the header
}

TEST(CyclicBox, EnergyBalanceOfTheLoadCloses) {
  EXPECT_LT(std::abs(value_of(stage_of(summary(), "cyclic").results, "energy_error")), 0.01);
}

TEST(CyclicBox, LeavesAllFiles) {
  summary();
  for (const char* file :
       {"series.csv", "summary.json", "contacts.csv", "stones.csv", "bed.png", "forces.png",
        "paraview/stones.pvd", "paraview/contacts.pvd", "paraview/walls.pvd"})
    EXPECT_GT(fs::exists(out / file) ? fs::file_size(out / file) : 0u, 100u) << file;
}

TEST(CyclicBox, SummaryTellsTheRun) {
  summary();
  const auto json = nlohmann::json::parse(read_file(out / "summary.json"));
  EXPECT_EQ(json["title"], "Cyclic ballast-box test");
  EXPECT_FALSE(json["version"].get<std::string>().empty());
  EXPECT_EQ(json["seed"], 1);
  EXPECT_GE(json["threads"], 1);
  EXPECT_EQ(json["input"]["stones"]["shapes"], 10);
  EXPECT_TRUE(json["state_hash"].get<std::string>().starts_with("0x"));
  EXPECT_EQ(json["measures"]["porosity"]["unit"], "-");
  EXPECT_TRUE(json["measures"]["porosity"]["value"].is_number());
  EXPECT_EQ(json["stages"].size(), 7u);
  for (const auto& stage : json["stages"]) {
    EXPECT_TRUE(stage["name"].is_string());
    EXPECT_TRUE(stage["steps"].is_number_integer());
    EXPECT_TRUE(stage["simulated_s"].is_number()) << stage["name"];
    EXPECT_TRUE(stage["wall_s"].is_number()) << stage["name"];
  }
}

}  // namespace
}  // namespace trackbed
