#include "lab/study/study.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <sstream>

#include "base/error.h"
#include "base/rng.h"
#include "io/files.h"
#include "lab/study/fits.h"
#include "lab/study/foreseen.h"
#include "lab/study/results.h"
#include "lab/study/statistics.h"
#include "scenes/temporary_folder.h"

namespace trackbed {
namespace {

// Table of Student's t: 0.975 for 2 and 9 degrees of freedom is 4.30265 and 2.26216.
TEST(Estimate, IntervalIsStudents) {
  const Estimate three = estimate({1, 2, 3});
  EXPECT_EQ(three.n, 3);
  EXPECT_NEAR(three.mean, 2, 1e-15);
  EXPECT_NEAR(three.deviation, 1, 1e-15);
  EXPECT_NEAR(three.half_width, 4.30265 / std::sqrt(3.0), 1e-5);
  EXPECT_NEAR(three.relative_width(), three.half_width / 2, 1e-15);
  const Estimate ten = estimate({1, 2, 3, 4, 5, 6, 7, 8, 9, 10});
  EXPECT_NEAR(ten.deviation, std::sqrt(82.5 / 9), 1e-12);
  EXPECT_NEAR(ten.half_width, 2.26216 * ten.deviation / std::sqrt(10.0), 1e-5);
}

TEST(Estimate, OneValueTellsNothingOfTheSpread) {
  const Estimate one = estimate({5, NAN});
  EXPECT_EQ(one.n, 1);
  EXPECT_EQ(one.mean, 5);
  EXPECT_TRUE(std::isnan(one.deviation) && std::isnan(one.low()));
  EXPECT_TRUE(std::isinf(one.relative_width()));
  EXPECT_TRUE(std::isnan(estimate({}).mean));
  EXPECT_EQ(estimate({3, 3}).relative_width(), 0);
}

// By hand: x 1 to 5, slope 19.9/10, squares of the residuals 0.107, t(0.975, 3) = 3.18245.
TEST(LineFit, IsThatOfTheFormulas) {
  const LineFit line = fit_line({1, 2, 3, 4, 5}, {2.1, 3.9, 6.2, 7.8, 10.1});
  EXPECT_EQ(line.n, 5);
  EXPECT_NEAR(line.slope, 1.99, 1e-12);
  EXPECT_NEAR(line.intercept, 0.05, 1e-12);
  EXPECT_NEAR(line.slope_half_width, 3.18245 * std::sqrt(0.107 / 3 / 10), 1e-5);
  EXPECT_NEAR(line.intercept_half_width, 3.18245 * std::sqrt(0.107 / 3 * 1.1), 1e-5);
  EXPECT_NEAR(line.r_squared, 1 - 0.107 / 39.708, 1e-9);
}

// Of 4000 lines with normal noise, 95 % of the intervals hold what the noise was added to; 0.34 % is one
// standard deviation of that share.
TEST(LineFit, IntervalsHoldTheTruthAsOftenAsTheySay) {
  Rng rng(7, "noise");
  const std::vector<double> x{50, 50, 50, 100, 100, 100, 200, 200, 200};
  constexpr double intercept = 10, slope = 1.75;
  constexpr int lines = 4000;
  int intercepts = 0, slopes = 0;
  for (int k = 0; k < lines; ++k) {
    std::vector<double> y;
    for (const double at : x) y.push_back(intercept + slope * at + 8 * rng.normal());
    const LineFit line = fit_line(x, y);
    intercepts += std::abs(line.intercept - intercept) < line.intercept_half_width;
    slopes += std::abs(line.slope - slope) < line.slope_half_width;
  }
  EXPECT_NEAR(intercepts / double(lines), 0.95, 4 * 0.0034);
  EXPECT_NEAR(slopes / double(lines), 0.95, 4 * 0.0034);
}

TEST(LineFit, OfTooFewPointsIsNotKnown) {
  EXPECT_TRUE(std::isnan(fit_line({1}, {2}).slope));
  EXPECT_TRUE(std::isnan(fit_line({1, 1, 1}, {2, 3, 4}).slope));
  const LineFit two = fit_line({0, 2, NAN}, {1, 5, 7});
  EXPECT_EQ(two.n, 2);
  EXPECT_EQ(two.slope, 2);
  EXPECT_TRUE(std::isnan(two.slope_half_width) && std::isnan(two.intercept_half_width));
}

// W. Jia (2023), Paper IV: peak shear stresses of fresh ballast at three normal stresses [kPa], and the angle
// of 60.27 degrees that it gives for all repeats; of recycled ballast 46.13 degrees.
TEST(LineFit, PublishedPeaksGiveThePublishedAngle) {
  const auto angle = [](const std::vector<double>& peaks) {
    return std::atan(fit_line({50, 100, 200}, peaks).slope) * 180 / std::numbers::pi;
  };
  EXPECT_NEAR(angle({99.7, 182.0, 362.6}), 60.27, 0.3);
  EXPECT_NEAR(angle({65.2, 115.6, 220.8}), 46.13, 0.3);
}

constexpr const char* small_case = R"toml(
title = "A box"
materials.ballast = { kn = "1e6 N/m", ks = "1e6 N/m", density = "2650 kg/m^3" }
walls.box = { kind = "box", size = ["0.2 m", "0.2 m", "0.2 m"], material = "ballast" }
[[stages]]
kind = "fill"
)toml";

class Study : public testing::Test {
 protected:
  void SetUp() override { write_file(folder_.path / "case.toml", small_case); }

  Document document(const std::string& text) {
    write_file(folder_.path / "study.toml", "title = \"A study\"\ncase = \"case.toml\"\n" + text);
    return Document(folder_.path / "study.toml");
  }
  std::vector<Condition> conditions(const std::string& text) {
    const Document file = document(text);
    study_ = {};
    file.read(study_);
    return conditions_of(file, study_);
  }

  TemporaryFolder folder_;
  StudyInput study_;
};

TEST_F(Study, SweepsAreCrossedTheLastOneFastest) {
  const auto all = conditions(R"(
repeats = 2
[[sweep]]
key = "stones.ratio"
values = ["0.3", "0.4"]
[[sweep]]
key = "stages.fill.porosity"
values = ["0.5", "0.6"]
)");
  ASSERT_EQ(all.size(), 4u);
  EXPECT_EQ(all[0].name, "ratio 0.3, porosity 0.5");
  EXPECT_EQ(all[1].name, "ratio 0.3, porosity 0.6");
  EXPECT_EQ(all[2].name, "ratio 0.4, porosity 0.5");
  EXPECT_EQ(all[3].inputs.at("stones.ratio"), "0.4");
  const auto members = members_of(study_, all);
  ASSERT_EQ(members.size(), 8u);
  EXPECT_EQ(members[0].name, "ratio_0.3_porosity_0.5-seed-1");
  EXPECT_EQ(members[7].name, "ratio_0.4_porosity_0.6-seed-2");
  EXPECT_EQ(members[7].input["seed"], 2);
  EXPECT_EQ(members[7].input["stages"][0]["porosity"], 0.6);
}

TEST_F(Study, OneSweepGoesAlongWithAnother) {
  const auto all = conditions(R"(
[[conditions]]
name = "coarse"
set = ["stones.shapes=2"]
[[sweep]]
key = "stones.distance"
values = ["160 deg", "140 deg"]
[[sweep]]
key = "stones.ratio"
along = "stones.distance"
values = ["0.3", "0.5"]
)");
  ASSERT_EQ(all.size(), 2u);
  EXPECT_EQ(all[1].name, "coarse, distance 140 deg");
  EXPECT_EQ(all[1].inputs.at("stones.ratio"), "0.5");
  EXPECT_EQ(all[1].inputs.at("stones.shapes"), "2");
}

TEST_F(Study, WrongFilesAreToldByTheirPlace) {
  const auto message = [&](const std::string& text) -> std::string {
    try {
      members_of(study_, conditions(text));
    } catch (const InputError& error) {
      return error.what();
    }
    return "no error";
  };
  EXPECT_NE(message("[[sweep]]\nkey = \"stones.ratio\"\nvalues = [\"0.3\"]\nalong = \"stones.size\"\n")
                .find("study.toml:6:9: error: there is no sweep of stones.size to go along with"),
            std::string::npos);
  EXPECT_NE(message("[[conditions]]\nname = \"a\"\n[[conditions]]\nname = \"a\"\n")
                .find("two conditions are called a"),
            std::string::npos);
  const std::string unknown = message("[[sweep]]\nkey = \"stones.ration\"\nvalues = [\"0.3\"]\n");
  EXPECT_NE(unknown.find("the condition ration 0.3: "), std::string::npos) << unknown;
  EXPECT_NE(unknown.find("ratio"), std::string::npos) << unknown;
}

/// What is said of a study's measures before anything runs; nothing when all is well.
std::string told_of_measures(const Document& document) {
  StudyInput study;
  document.read(study);
  try {
    check_measures(document, study, {study, conditions_of(document, study)});
  } catch (const InputError& error) {
    return error.what();
  }
  return {};
}

TEST_F(Study, AMeasureThatNoRunLeavesIsRefusedBeforeTheFirst) {
  EXPECT_EQ(told_of_measures(document("measures = [\"porosity\", \"fill.added\", \"fill.stones\", "
                                      "\"fill.passing_31.5_mm\", \"box.left.force_x\"]\n")),
            "");
  const std::string told = told_of_measures(document("measures = [\"porosity\", \"fill.aded\"]\n"));
  EXPECT_NE(told.find("study.toml:3:12: error: no run leaves a measure called fill.aded"), std::string::npos)
      << told;
  EXPECT_NE(told.find("did you mean fill.added?"), std::string::npos) << told;
  EXPECT_NE(told_of_measures(document("measures = [\"fill.passing_two_mm\"]\n")), "");
}

// Each run may leave what the others do not.
TEST_F(Study, MeasuresAreThoseOfAnyCondition) {
  const std::string conditions =
      "[[conditions]]\nname = \"small\"\n[[conditions]]\nname = \"binned\"\nset = "
      "[\"record.force_bins=[\\\"7 N\\\"]\"]\n";
  EXPECT_EQ(told_of_measures(
                document("measures = [\"contacts_below_7_N\", \"contacts_below_100_N\"]\n" + conditions)),
            "");
  EXPECT_NE(told_of_measures(document("measures = [\"contacts_below_8_N\"]\n" + conditions)), "");
}

TEST_F(Study, ALineThroughAMeasureThatNoRunLeavesIsRefused) {
  const std::string told =
      told_of_measures(document("[[sweep]]\nkey = \"stones.shapes\"\nvalues = [\"2\", \"3\"]\n"
                                "[[fits]]\nname = \"line\"\nx = \"stones.shapes\"\ny = \"porosty\"\n"));
  EXPECT_NE(told.find("study.toml:9:5: error: no run leaves a measure called porosty"), std::string::npos)
      << told;
}

/// Leaves a summary as a run does.
void finish(const Member& member, const std::filesystem::path& folder, double settlement) {
  make_folder(folder);
  const nlohmann::ordered_json summary{
      {"input", member.input},
      {"stages",
       {{{"name", "load"},
         {"results", {{"settlement", {{"value", settlement}, {"unit", "m"}}}}},
         {"measures", {{"porosity", {{"value", 0.3}, {"unit", "-"}}}}}}}},
      {"measures",
       {{"load.settlement", {{"value", settlement}, {"unit", "m"}}},
        {"porosity", {{"value", 0.4}, {"unit", "-"}}}}},
      {"wall_s", 12.5},
      {"state_hash", "0x0123"}};
  write_file(folder / "summary.json", summary.dump());
}

TEST_F(Study, ResultsCountWhileTheInputIsTheSame) {
  auto all = conditions("repeats = 1\n");
  Member member = members_of(study_, all)[0];
  const auto out = folder_.path / "member";
  EXPECT_EQ(outcome_of(member, out).status, MemberStatus::waiting);
  finish(member, out, 0.001);
  EXPECT_EQ(outcome_of(member, out).status, MemberStatus::done);

  // A comment in the case changes nothing, a value does.
  write_file(folder_.path / "case.toml", std::string("# the same\n") + small_case);
  EXPECT_EQ(outcome_of(members_of(study_, all)[0], out).status, MemberStatus::done);
  all = conditions("repeats = 1\nset = [\"stages.fill.porosity=0.55\"]\n");
  const Outcome changed = outcome_of(members_of(study_, all)[0], out);
  EXPECT_EQ(changed.status, MemberStatus::waiting);
  EXPECT_EQ(changed.cause, "stages.fill.porosity: 0.4 -> 0.55");
}

TEST_F(Study, AFailureIsKeptWithItsCause) {
  const auto all = conditions("repeats = 1\n");
  const Member member = members_of(study_, all)[0];
  write_failure(member, "exit 1: it blew up", folder_.path / "member");
  const Outcome outcome = outcome_of(member, folder_.path / "member");
  EXPECT_EQ(outcome.status, MemberStatus::failed);
  EXPECT_EQ(outcome.cause, "exit 1: it blew up");
}

TEST_F(Study, TablesHoldInputsMeasuresAndTheirSpread) {
  const auto all = conditions("repeats = 3\n[[sweep]]\nkey = \"stages.fill.porosity\"\nvalues = [\"0.5\"]\n");
  auto members = members_of(study_, all);
  std::vector<Outcome> outcomes;
  for (std::size_t k = 0; k < members.size(); ++k) {
    const auto out = folder_.path / members[k].name;
    if (k < 2) finish(members[k], out, 0.001 * static_cast<double>(k + 1));
    if (k == 2) write_failure(members[k], "exit 1: no, \"really\"", out);
    outcomes.push_back(outcome_of(members[k], out));
  }
  write_members(study_, all, members, outcomes, folder_.path / "study.csv");
  EXPECT_EQ(
      read_file(folder_.path / "study.csv"),
      "member,condition,stages.fill.porosity,seed,status,cause,load.settlement [m],wall time [s],state hash\n"
      "porosity_0.5-seed-1,porosity 0.5,0.5,1,done,,0.001,12.5,0x0123\n"
      "porosity_0.5-seed-2,porosity 0.5,0.5,2,done,,0.002,12.5,0x0123\n"
      "porosity_0.5-seed-3,porosity 0.5,0.5,3,failed,\"exit 1: no, \"\"really\"\"\",,,\n");
  write_table(study_, all, members, outcomes, folder_.path / "table.csv");
  const std::string table = read_file(folder_.path / "table.csv");
  EXPECT_TRUE(
      table.starts_with("condition,stages.fill.porosity,measure,unit,n,mean,standard deviation,95 % low,"
                        "95 % high\nporosity 0.5,0.5,load.settlement,m,2,0.0015,"))
      << table;

  // At the end of the run and at that of a stage.
  EXPECT_EQ(measure_in(outcomes[0].summary, "porosity"), 0.4);
  EXPECT_EQ(measure_in(outcomes[0].summary, "load.porosity"), 0.3);
  EXPECT_FALSE(measure_in(outcomes[0].summary, "fill.porosity"));
  study_.measures = {"load.porosity"};
  write_table(study_, all, members, outcomes, folder_.path / "table.csv");
  EXPECT_NE(read_file(folder_.path / "table.csv").find("porosity 0.5,0.5,load.porosity,-,2,0.3,0,0.3,0.3\n"),
            std::string::npos);

  // Unknown while one is missing: it may be what only that one leaves.
  study_.measures = {"porosity", "load.setlement"};
  EXPECT_NO_THROW(write_table(study_, all, members, outcomes, folder_.path / "table.csv"));
  members.pop_back();
  outcomes.pop_back();
  EXPECT_THROW(write_table(study_, all, members, outcomes, folder_.path / "table.csv"), InputError);
}

TEST_F(Study, FitsALineThroughMembersThatDifferInXAlone) {
  write_file(folder_.path / "case.toml", std::string(small_case) + R"(
[[stages]]
kind = "insert"
body = "plate"
[[stages]]
kind = "load"
body = "plate"
force_max = "1 kN"
duration = "1 s"
[bodies.plate]
kind = "block"
size = ["0.1 m", "0.1 m", "0.1 m"]
material = "ballast"
)");
  const auto all = conditions(R"(
repeats = 2
[[sweep]]
key = "stones.ratio"
values = ["0.3", "0.4"]
[[sweep]]
key = "stages.load.force_max"
values = ["1 kN", "2 kN"]
[[fits]]
name = "strength"
x = "stages.load.force_max"
y = "load.force_peak"
area = "0.5 m^2"
)");
  const auto members = members_of(study_, all);
  std::vector<Outcome> outcomes;
  for (const Member& member : members) {
    // Two repeats on either side of the line peak = 100 N + 2 x force.
    const double x = all[member.condition].inputs.at("stages.load.force_max") == "1 kN" ? 1000 : 2000;
    const double peak = 100 + 2 * x + (member.seed == 1 ? 30 : -30);
    Outcome outcome{MemberStatus::done, "", {}};
    outcome.summary = {{"measures", {{"load.force_peak", {{"value", peak}, {"unit", "N"}}}}},
                       {"stages", nlohmann::ordered_json::array()}};
    outcomes.push_back(outcome);
  }
  outcomes.back() = {MemberStatus::failed, "it blew up", {}};
  write_fits(study_, all, members, outcomes, folder_.path / "fits.csv");
  std::istringstream table(read_file(folder_.path / "fits.csv"));
  std::string line;
  std::getline(table, line);
  EXPECT_EQ(line,
            "fit,stones.ratio,n,unit of y,intercept,95 % low,95 % high,unit of the slope,slope,95 % low,"
            "95 % high,angle [deg],95 % low,95 % high,R^2");
  std::getline(table, line);
  std::vector<std::string> cells;
  std::istringstream row(line);
  for (std::string cell; std::getline(row, cell, ',');) cells.push_back(cell);
  ASSERT_EQ(cells.size(), 15u) << line;
  EXPECT_EQ(cells[0] + cells[1] + cells[2] + cells[3] + cells[7], "strength0.34Pa-");
  EXPECT_NEAR(std::stod(cells[4]), 200, 1e-9);
  EXPECT_NEAR(std::stod(cells[8]), 2, 1e-12);
  EXPECT_NEAR(std::stod(cells[11]), std::atan(2) * 180 / std::numbers::pi, 1e-9);
  // s^2 = 4 x 60^2 / 2 Pa^2, S = 4 x 1000^2 Pa^2, t(0.975, 2) = 4.30265.
  EXPECT_NEAR(std::stod(cells[10]) - 2, 4.30265 * std::sqrt(7200.0 / 4e6), 1e-5);
  std::getline(table, line);
  EXPECT_TRUE(line.starts_with("strength,0.4,3,Pa,")) << line;  // without the member that failed
}

TEST_F(Study, AFitAgainstAKeyThatNothingChangesIsRefused) {
  try {
    conditions("[[fits]]\nname = \"a\"\nx = \"stones.ratio\"\ny = \"stones\"\n");
    FAIL() << "there is one value of x";
  } catch (const InputError& error) {
    EXPECT_NE(std::string(error.what()).find("study.toml:5:5: error: no condition changes stones.ratio"),
              std::string::npos)
        << error.what();
  }
}

}  // namespace
}  // namespace trackbed
