// cases/shape-study: its stones are those of the thesis, and a short form gives the orders it found.
#include <gtest/gtest.h>

#include <filesystem>
#include <map>
#include <stdexcept>

#include "expected.h"
#include "lab/case.h"
#include "lab/study/results.h"
#include "lab/study/study.h"
#include "scenes/study_process.h"
#include "scenes/temporary_folder.h"

namespace trackbed {
namespace {

namespace fs = std::filesystem;

const fs::path folder = fs::path(TRACKBED_ROOT) / "cases/shape-study";

/// The mean of a measure is larger in the conditions `above` than in all of the conditions `below`.
struct ExpectedOrder {
  std::string measure;
  std::vector<std::string> above, below;
  std::string reason;
};

struct ExpectedOrders {
  std::vector<std::string> set;
  int repeats = 1;
  std::vector<ExpectedOrder> orders;
};

void declare(Fields& f, ExpectedOrder& in) {
  f.text(required("measure"), in.measure, "as in the tables of the study");
  f.texts(required("above"), in.above, "conditions in each of which its mean is larger ...");
  f.texts(required("below"), in.below, "... than in each of these");
  f.text(required("reason"), in.reason, "who found it");
}

void declare(Fields& f, ExpectedOrders& in) {
  f.texts("set", in.set, "changes that make the members short");
  f.integer("repeats", in.repeats, {.at_least = 2}, "seeds of each condition");
  f.sequence(required("orders"), in.orders, "what must come out");
}

struct ShapeStudy {
  Document document{folder / "study.toml"};
  StudyInput study;
  std::vector<Condition> conditions;

  ShapeStudy() {
    document.read(study);
    conditions = conditions_of(document, study);
  }
  std::size_t condition(const std::string& name) const {
    for (std::size_t c = 0; c < conditions.size(); ++c)
      if (conditions[c].name == name) return c;
    throw std::runtime_error("there is no condition " + name);
  }
};

TEST(shape_study, has_the_conditions_of_the_thesis_with_ten_beds_each) {
  const ShapeStudy s;
  EXPECT_EQ(s.conditions.size(), 22u);
  EXPECT_EQ(members_of(s.study, s.conditions).size(), 220u);
}

TEST(shape_study, stones_have_the_pebbles_of_the_thesis_and_one_volume) {
  ShapeStudy s;
  double volume = 0;
  for (const auto& [type, pebbles] :
       std::map<std::string, std::size_t>{{"Type 11", 269}, {"Type 7", 15}, {"Type 9", 2}, {"Type 10", 1}}) {
    const Member member = make_member(s.study, s.conditions, s.condition(type), 7);
    const Document document(s.study.base, member.set);
    CaseInput experiment;
    document.read(experiment);
    const Simulation sim = make_simulation(document, experiment);
    const ClumpTemplate& stone = sim.model.templates.at(static_cast<std::size_t>(sim.stone_set("").first));
    EXPECT_EQ(sim.stone_set("").count, 1);
    EXPECT_EQ(stone.pebbles.size(), pebbles) << type;
    EXPECT_NEAR(stone.pebble_volume / stone.volume, 1, 2e-3) << type;
    if (type != "Type 10" && volume == 0) volume = stone.volume;
    if (type != "Type 10") {
      EXPECT_EQ(stone.volume, volume) << type;  // one shape
    }
  }
}

TEST(shape_study, long_short_form_gives_the_orders_of_the_thesis) {
  const auto expected = read_input<ExpectedOrders>(folder / "expected.toml");
  const TemporaryFolder out;
  std::vector<std::string> options{"--repeats", std::to_string(expected.repeats)};
  for (const std::string& change : expected.set) options.insert(options.end(), {"--set", change});
  ShapeStudy s;
  ASSERT_EQ(StudyProcess(TRACKBED_PROGRAM, folder / "study.toml", out.path / "out", options).wait(), 0);
  s.study.repeats = expected.repeats;
  s.study.set.insert(s.study.set.end(), expected.set.begin(), expected.set.end());
  const std::vector<Member> members = members_of(s.study, s.conditions);
  std::vector<Outcome> outcomes;
  for (const Member& member : members)
    outcomes.push_back(outcome_of(member, out.path / "out/members" / member.name));
  const auto mean = [&](const std::string& measure, const std::string& condition) {
    return estimate_of(measure, s.condition(condition), members, outcomes).mean;
  };
  for (const ExpectedOrder& order : expected.orders)
    for (const std::string& above : order.above)
      for (const std::string& below : order.below)
        EXPECT_GT(mean(order.measure, above), mean(order.measure, below))
            << order.measure << " of " << above << " and " << below << ": " << order.reason;
}

}  // namespace
}  // namespace trackbed
