// Cases that are wrong, and those that ship.
#include <fmt/format.h>

#include "bad_files.h"
#include "lab/run.h"
#include "lab/track/track_case.h"

namespace trackbed {
namespace {

namespace fs = std::filesystem;

Simulation prepared(const fs::path& file, const std::vector<std::string>& overrides = {}) {
  const Document document(file, overrides);
  CaseInput input;
  document.read(input);
  return prepare_run(document, input);
}

void prepared_track(const fs::path& file) {
  const Document document(file);
  TrackCaseInput input;
  document.read(input);
  check_track(document, input);
}

TEST(BadFiles, Track) {
  expect_messages<TrackCaseInput>(
      fs::path(TRACKBED_ROOT) / "tests/input/track",
      [](const Document& document, const TrackCaseInput& input) { check_track(document, input); });
}

TEST(BadFiles, Case) {
  expect_messages<CaseInput>(
      fs::path(TRACKBED_ROOT) / "tests/input/case",
      [](const Document& document, const CaseInput& input) { prepare_run(document, input); });
}

/// A minimal case whose stones or sleeper come from a file.
Simulation with_file(const std::string& line) {
  const std::string text = "title = \"A mesh\"\n" + line + R"(
materials.ballast = { kn = "1e7 N/m", ks = "1e7 N/m", density = "2000 kg/m^3" }
walls.box = { kind = "box", size = ["0.3 m", "0.3 m", "0.2 m"], material = "ballast" }
[[stages]]
kind = "fill"
)";
  const Document document = Document::from_text(text, fs::path(TRACKBED_ROOT) / "tests/input/case/made.toml");
  CaseInput input;
  document.read(input);
  return prepare_run(document, input);
}

TEST(Meshes, InwardFacetsOfABodyAreTurned) {
  const Simulation sim = with_file(
      "stones.fidelity = \"ball\"\n"
      "bodies.sleeper = { kind = \"mesh\", file = \"inward.obj\", unit = \"0.5 m\", material = \"ballast\" "
      "}\n");
  const Wall& sleeper = sim.model.walls[static_cast<std::size_t>(sim.find_wall("sleeper"))];
  EXPECT_NEAR(sleeper.body->mass, 2000 * 0.125, 1e-9);
}

TEST(Meshes, InwardFacetsOfAStoneAreTurned) {
  const Simulation sim =
      with_file("stones = { files = \"inward.obj\", distance = \"90 deg\", ratio = 0.5 }\n");
  ASSERT_EQ(sim.model.templates.size(), 1u);
  EXPECT_NEAR(sim.model.templates[0].volume, 0.04 * 0.04 * 0.04, 1e-12);
}

TEST(Cases, AllThatShipCanBeRun) {
  const std::vector<fs::path> files = expand_pattern(fs::path(TRACKBED_ROOT) / "cases/*/case.toml");
  ASSERT_FALSE(files.empty());
  for (const fs::path& file : files) {
    if (is_track_case(Document(file))) {
      EXPECT_NO_THROW(prepared_track(file)) << file;
    } else {
      EXPECT_NO_THROW(prepared(file)) << file;
    }
  }
}

TEST(Cases, TakeOtherValues) {
  const fs::path file = fs::path(TRACKBED_ROOT) / "cases/cyclic-box/case.toml";
  const Simulation sim = prepared(file, {"seed=3", "stones.fidelity=ball", "stages.cyclic.force_max=20 kN",
                                         "walls.box.size=[\"0.5 m\", \"0.4 m\", \"300 mm\"]"});
  EXPECT_EQ(sim.seed, 3u);
  EXPECT_EQ(sim.container.sizes(), Vec3(0.5, 0.4, 0.3));
}

TEST(Cases, TakeScannedStones) {
  const std::vector<fs::path> scans = expand_pattern(fs::path(TRACKBED_STONES) / "*/*_00[0-2].obj");
  if (scans.empty()) GTEST_SKIP() << "there are no scanned stones in " << TRACKBED_STONES;
  const Simulation sim =
      prepared(fs::path(TRACKBED_ROOT) / "cases/cyclic-box/case.toml",
               {fmt::format("stones.files=\"{}/*/*_00[0-2].obj\"", TRACKBED_STONES), "stones.ratio=0.5",
                "stones.distance=100 deg", "stones.largest_elongation=100"});
  EXPECT_EQ(sim.model.templates.size(), scans.size());
}

}  // namespace
}  // namespace trackbed
