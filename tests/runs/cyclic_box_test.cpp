// The cyclic box test in a short form: few, coarse and soft stones, half a cycle.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "expected.h"
#include "io/files.h"
#include "scenes/temporary_folder.h"

namespace trackbed {
namespace {

namespace fs = std::filesystem;

void box_carries_stones_sleeper_and_load(const Summary& summary) {
  const StageSummary& rest = stage_of(summary, "before");
  double carried = 0;
  for (const char* side : {"floor", "left", "right", "front", "back"})
    carried -= value_of(rest.measures, std::string("box.") + side + ".force_z");
  const double load = 380;  // [N]
  const double all = value_of(rest.measures, "weight") + load;
  EXPECT_NEAR(carried, all, 1e-3 * all);
}

void no_stone_is_lost(const Summary& summary, const fs::path& out) {
  const double added = value_of(stage_of(summary, "fill").results, "added");
  const double removed = value_of(stage_of(summary, "insert").results, "removed");
  EXPECT_EQ(value_of(summary.measures, "stones"), added - removed);
  const std::string table = read_file(out / "stones.csv");
  EXPECT_EQ(std::ranges::count(table, '\n'), std::lround(added - removed) + 1);  // and the header
}

void energy_balance_of_the_load_closes(const Summary& summary) {
  EXPECT_LT(std::abs(value_of(stage_of(summary, "cyclic").results, "energy_error")), 0.01);
}

void leaves_all_files(const fs::path& out) {
  for (const char* file :
       {"series.csv", "summary.json", "contacts.csv", "stones.csv", "bed.png", "forces.png",
        "displacements.png", "paraview/stones.pvd", "paraview/contacts.pvd", "paraview/walls.pvd"})
    EXPECT_GT(fs::exists(out / file) ? fs::file_size(out / file) : 0u, 100u) << file;
}

void summary_tells_the_run(const fs::path& out) {
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

void expect_sound(const Summary& summary, const fs::path& out) {
  box_carries_stones_sleeper_and_load(summary);
  no_stone_is_lost(summary, out);
  energy_balance_of_the_load_closes(summary);
  leaves_all_files(out);
  summary_tells_the_run(out);
}

TEST(cyclic_box, short_form_gives_what_the_case_expects) {
  const TemporaryFolder folder;
  const fs::path& out = folder.path;
  expect_sound(run_and_compare("cyclic-box", out), out);
}

Summary run_whole(const std::vector<std::string>& set, int threads, const fs::path& out) {
  const Document document(TRACKBED_ROOT "/cases/cyclic-box/case.toml", set);
  CaseInput experiment;
  document.read(experiment);
  return run(document, experiment, {.out = out, .threads = threads, .quiet = true});
}

// The whole test at full load with some 430 pebbles a stone, on the default stones and on scans.
TEST(cyclic_box, long_whole_run_is_sound_and_the_same_for_any_number_of_threads) {
  const TemporaryFolder folder;
  const fs::path& out = folder.path;
  const Summary two = run_whole({}, 2, out);
  expect_sound(two, out);
  EXPECT_EQ(run_whole({}, 1, out).state_hash, two.state_hash);
  EXPECT_EQ(run_whole({}, 4, out).state_hash, two.state_hash);
}

TEST(cyclic_box, long_whole_run_on_scans_is_sound) {
  if (!fs::exists(TRACKBED_STONES)) GTEST_SKIP() << "the folder of scans is not here: " << TRACKBED_STONES;
  const TemporaryFolder folder;
  const fs::path& out = folder.path;
  expect_sound(
      run_whole({std::string("stones.files=\"") + TRACKBED_STONES + "/epfl_stonepacking3d/*.obj\""}, 2, out),
      out);
}

}  // namespace
}  // namespace trackbed
