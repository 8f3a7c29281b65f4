#include "io/describe.h"

#include <gtest/gtest.h>

#include "base/error.h"
#include "io/echo.h"
#include "io/read.h"
#include "sample_input.h"

namespace trackbed {
namespace {

Description sample_description() {
  return describe<sample::Case>("Input", "One case.");
}

TEST(Describe, OneKind) {
  EXPECT_EQ(to_text(sample_description().find("settle")),
            "settle: wait until the stones are at rest\n"
            "  name              text; default \"\"\n"
            "                    name of the stage\n"
            "  unbalanced_ratio  number; above 0 and at most 1; default 0.001\n"
            "                    stop below this ratio\n"
            "  time_limit        time [s]; above 0 s; required\n"
            "                    fail after this time\n");
}

// With what it leaves only for some values, too.
TEST(Describe, WhatAKindLeaves) {
  const std::string text = to_text(sample_description().find("load"));
  EXPECT_TRUE(
      text.ends_with("results:\n"
                     "  peak               [N]  the largest force\n"
                     "  force_at_NUMBER_s  [N]  force at a time that nobody asks for\n"))
      << text;
  const std::string page = to_markdown(sample_description());
  EXPECT_NE(page.find("| `force_max` | force [N] | `\"1000 N\"` | above 0 N | highest force |\n\n"
                      "| result | unit | meaning |\n|---|---|---|\n| `peak` | N | the largest force |\n"),
            std::string::npos)
      << page;
}

TEST(Describe, OneSection) {
  EXPECT_EQ(to_text(sample_description().find("contact")),
            "contact\n"
            "  contact           table\n"
            "                    how stones touch\n"
            "  contact.law       one of: linear, hertz; default \"linear\"\n"
            "                    contact law\n"
            "  contact.kn        stiffness [N/m]; above 0 N/m and at most 1000000000000 N/m; default "
            "\"10000000 N/m\"\n"
            "                    normal stiffness\n"
            "  contact.friction  number; from 0 to 10; may be absent\n"
            "                    Coulomb coefficient of all contacts\n"
            "  contact.rolling   true or false; default false\n"
            "                    resistance to rolling\n");
}

TEST(Describe, UnknownNameNamesTheNearest) {
  try {
    sample_description().find("setle");
    FAIL();
  } catch (const InputError& error) {
    EXPECT_TRUE(std::string(error.what())
                    .starts_with("there is nothing called setle to describe\n  hint: did you mean settle? "
                                 "known here: settle,"))
        << error.what();
  }
}

TEST(Describe, WholeInput) {
  const std::string text = to_text(sample_description());
  EXPECT_NE(text.find("  materials.NAME.density "), std::string::npos);
  EXPECT_TRUE(
      text.ends_with("\nevery stage:\n"
                     "  settle  wait until the stones are at rest\n"
                     "  load    a force over time\n"
                     "  cycle   repeat a list of stages\n"))
      << text;
}

TEST(Describe, Markdown) {
  const std::string text = to_markdown(sample_description());
  EXPECT_TRUE(text.starts_with("# Input\n\nOne case.\n\n"));
  EXPECT_NE(text.find("| `gravity` | list of three: acceleration [m/s^2] | `[\"0 m/s^2\", \"0 m/s^2\", "
                      "\"-9.81 m/s^2\"]` |"
                      "  | x, y and z |\n"),
            std::string::npos)
      << text;
  EXPECT_NE(
      text.find("### cycle\n\nrepeat a list of stages\n\n"
                "| key | value | default | range | meaning |\n|---|---|---|---|---|\n"
                "| `name` | text | `\"\"` |  | name of the stage |\n"
                "| `count` | whole number | `1` | from 1 to 4294967295 | how often |\n"
                "| `stages` | list of tables; kind: a stage, see there | required |  | what is repeated |\n"),
      std::string::npos)
      << text;
  // A stage that holds stages is described once.
  EXPECT_EQ(text.find("### settle"), text.rfind("### settle"));
}

TEST(Echo, ReadsBackToTheSame) {
  sample::Case first;
  Document::from_text(sample::good_text, "case.toml").read(first);
  const nlohmann::ordered_json json = echo(first);
  EXPECT_EQ(json["contact"].dump(), R"({"law":"hertz","kn":"10000000 N/m","rolling":false})");
  EXPECT_EQ(json["gravity"].dump(), R"(["0 m/s^2","0 m/s^2","-9.80665 m/s^2"])");
  EXPECT_EQ(json["materials"].dump(), R"({"ballast":{"density":"2650 kg/m^3","friction":0.5}})");
  EXPECT_EQ(json["stages"][1].dump(),
            R"({"kind":"cycle","name":"","count":3,"stages":[{"kind":"load","name":"seat",)"
            R"("force_min":"0 N","force_max":"20000 N"}]})");
  EXPECT_FALSE(json.contains("output"));
  EXPECT_FALSE(json.contains("mesh"));
}

}  // namespace
}  // namespace trackbed
