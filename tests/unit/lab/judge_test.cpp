#include "lab/study/judge.h"

#include <gtest/gtest.h>

#include "base/error.h"
#include "io/files.h"
#include "scenes/temporary_folder.h"

namespace trackbed {
namespace {

namespace fs = std::filesystem;

/// A force of 1 N spread evenly over n places from 0 to 1.
Bearing even(int n) {
  Bearing b;
  for (int k = 0; k < n; ++k) {
    b.place.push_back((k + 0.5) / n);
    b.share.push_back(1.0 / n);
  }
  b.force = 1;
  b.largest = 1.0 / n;
  b.largest_place = 0.5 / n;
  return b;
}

/// All of it at one place.
Bearing at(double place) {
  return {{place}, {1.0}, 1.0, 1.0, place};
}

TEST(Judge, AMemberLikeItsReferencesIsAtNoDistance) {
  const Likeness l = compare(even(7), {even(7), even(7)});
  EXPECT_NEAR(l.distance, 0, 1e-15);
  EXPECT_NEAR(l.place, 0, 1e-15);
  EXPECT_NEAR(l.share, 1, 1e-15);
}

// The distance is the way by which the force has to be moved on the mean.
TEST(Judge, DistanceIsTheMeanWayOfTheForce) {
  EXPECT_NEAR(compare(at(0), {at(1)}).distance, 1, 1e-15);
  EXPECT_NEAR(compare(at(0.2), {at(0.5)}).distance, 0.3, 1e-15);
  EXPECT_NEAR(compare(at(0.5), {even(1000)}).distance, 0.25, 1e-6);  // even: 1/4 on the mean to the middle
  EXPECT_NEAR(compare(at(0), {even(1000)}).distance, 0.5, 1e-6);
  // Of the mean of the references: half of the force at each of two places.
  EXPECT_NEAR(compare(at(0), {at(0.2), at(0.6)}).distance, 0.4, 1e-15);
}

TEST(Judge, PlaceAndShareOfTheLargestForce) {
  const Likeness l = compare(even(4), {at(0.5), at(0.25)});
  EXPECT_NEAR(l.place, 0.375 - 0.125, 1e-15);
  EXPECT_NEAR(l.share, 0.25, 1e-15);
}

TEST(Judge, TheRuleSaysWhyItRefuses) {
  JudgeInput rule;
  rule.distance = 0.2;
  rule.place = 0.3;
  rule.share = 2;
  EXPECT_EQ(refusal({0.2, 0.3, 2}, rule), "");
  EXPECT_EQ(refusal({0.2, 0.3, 0.5}, rule), "");
  EXPECT_EQ(refusal({0.21, 0, 1}, rule), "the force lies elsewhere: 0.21 of half the width, 0.2 is allowed");
  EXPECT_EQ(
      refusal({0, 0.31, 0.49}, rule),
      "the largest force acts 0.31 of half the width away, 0.3 is allowed; the largest force is 0.49 times "
      "as much of all, a factor of 2 is allowed");
}

/// Runs with a contacts table: x, normal_z, force, force_z of contacts with the sleeper; one with the floor.
class Judging : public ::testing::Test {
 protected:
  struct Contact {
    double x, normal_z, force, force_z;
  };
  fs::path add_run(const std::string& name, const std::vector<Contact>& contacts, double correction) {
    const fs::path run = folder_.path / name;
    std::string table = "wall,x [m],normal_z [-],force [N],force_z [N]\nbox.floor,0,-1,900,-900\n";
    for (const Contact& c : contacts)
      table += "sleeper," + std::to_string(c.x) + "," + std::to_string(c.normal_z) + "," +
               std::to_string(c.force) + "," + std::to_string(c.force_z) + "\n";
    make_folder(run / "stages");
    write_file(run / "stages/load-contacts.csv", table);
    write_file(run / "summary.json", R"({"measures": {"correction": {"value": )" +
                                         std::to_string(correction) + R"(, "unit": "m"}}, "stages": []})");
    return run;
  }
  static JudgeInput rule() {
    JudgeInput rule;
    rule.members = rule.references = {"load", 0.2, 0.05};
    rule.distance = 0.2;
    rule.place = 1;
    rule.share = 10;
    rule.measures = {"correction"};
    return rule;
  }
  TemporaryFolder folder_;
};

TEST_F(Judging, OnlyWhatPushesTheBodyUpCounts) {
  const fs::path run = add_run("one",
                               {{0.15, 1, 100, 100},       // the edge
                                {0.05, 0.7, 400, 300},     // the middle
                                {-0.05, 0.02, 5000, 50},   // on the side
                                {0.02, -1, 7000, -7000}},  // on the top
                               0);
  const Bearing b = read_bearing(run, "sleeper", rule().members);
  ASSERT_EQ(b.place.size(), 2u);
  EXPECT_NEAR(b.place[0], 0, 1e-12);
  EXPECT_NEAR(b.place[1], 1, 1e-12);
  EXPECT_NEAR(b.share[0], 0.75, 1e-12);
  EXPECT_EQ(b.force, 400);
  EXPECT_EQ(b.largest, 400);
  EXPECT_EQ(b.largest_place, 0);
}

TEST_F(Judging, ABodyThatHangsIsRefused) {
  const fs::path run = add_run("hangs", {}, 0);
  try {
    read_bearing(run, "sleeper", rule().members);
    FAIL();
  } catch (const InputError& error) {
    EXPECT_EQ(std::string(error.what()),
              (run / "stages/load-contacts.csv").string() + ": no stone pushes sleeper up");
  }
}

TEST_F(Judging, MeasuresAreGivenForAcceptedRefusedAndAll) {
  const std::vector<Contact> edges{{0.15, 1, 100, 100}}, middle{{0.05, 1, 100, 100}};
  add_run("study/members/wedge-seed-1", middle, 0.004);
  add_run("study/members/wedge-seed-2", middle, 0.006);
  add_run("study/members/wedge-seed-3", edges, 0.001);
  const fs::path reference = add_run("solid", middle, 0);
  const std::vector<Judged> runs = judge(rule(), {folder_.path / "study"}, {reference});
  write_judgement(rule(), runs, folder_.path);
  const std::string table = read_file(folder_.path / "judge-table.csv");
  EXPECT_NE(table.find("wedge,accepted,correction,m,2,0.005,"), std::string::npos) << table;
  EXPECT_NE(table.find("wedge,refused,correction,m,1,0.001,"), std::string::npos) << table;
  EXPECT_NE(table.find("wedge,all,correction,m,3,0.003666"), std::string::npos) << table;
  const std::string rows = read_file(folder_.path / "judge.csv");
  EXPECT_NE(rows.find("wedge-seed-3,wedge,refused,"), std::string::npos) << rows;
  EXPECT_NE(rows.find("solid,solid,reference,,,,,100,"), std::string::npos) << rows;  // beside nothing
}

TEST_F(Judging, AFolderWithoutRunsIsRefused) {
  EXPECT_THROW(judge(rule(), {folder_.path / "nothing"}, {folder_.path}), InputError);
}

}  // namespace
}  // namespace trackbed
