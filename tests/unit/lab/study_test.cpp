#include "lab/study/study.h"

#include <gtest/gtest.h>

#include <cmath>

#include "base/error.h"
#include "io/files.h"
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
  const auto members = members_of(study_, all);
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

  study_.measures = {"porosity", "load.setlement"};
  EXPECT_THROW(write_table(study_, all, members, outcomes, folder_.path / "table.csv"), InputError);
}

}  // namespace
}  // namespace trackbed
