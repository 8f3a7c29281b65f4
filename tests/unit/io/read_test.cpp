#include "io/read.h"

#include <gtest/gtest.h>

#include <fstream>

#include "base/error.h"
#include "sample_input.h"
#include "scenes/temporary_folder.h"

namespace trackbed {
namespace {

using sample::Case;

Case read(const std::string& text, const std::vector<std::string>& overrides = {}) {
  Case input;
  Document::from_text(text, "cases/box/case.toml", overrides).read(input);
  return input;
}

/// The message, or "" when nothing is wrong.
std::string error_of(const std::string& text, const std::vector<std::string>& overrides = {}) {
  try {
    read(text, overrides);
  } catch (const InputError& error) {
    return error.what();
  }
  return {};
}

TEST(Read, GoodFile) {
  const Case in = read(sample::good_text);
  EXPECT_EQ(in.title, "Cyclic box");
  EXPECT_EQ(in.seed, 7u);
  EXPECT_EQ(in.gravity, Vec3(0, 0, -9.80665));
  EXPECT_EQ(in.sieves, (std::vector<double>{0.0224, 0.0315}));
  EXPECT_EQ(in.measures, std::vector<std::string>{"porosity"});
  EXPECT_EQ(in.contact.law, "hertz");
  EXPECT_EQ(in.contact.kn, 1e7);
  EXPECT_FALSE(in.contact.friction);
  EXPECT_FALSE(in.output);
  EXPECT_EQ(in.materials.at("ballast").density, 2650.0);
  EXPECT_EQ(in.materials.at("ballast").friction, 0.5);
  ASSERT_EQ(in.stages.size(), 2u);
  EXPECT_EQ(in.stages[0].kind, "settle");
  EXPECT_EQ(dynamic_cast<const sample::Settle&>(*in.stages[0].input).time_limit, 5.0);
  const auto& cycle = dynamic_cast<const sample::Cycle&>(*in.stages[1].input);
  EXPECT_EQ(cycle.count, 3u);
  EXPECT_EQ(dynamic_cast<const sample::Load&>(*cycle.stages.at(0).input).force_max, 20e3);
}

TEST(Read, RangeOfValue) {
  EXPECT_EQ(error_of("title = \"a\"\n[contact]\nfriction = -0.5\n"),
            "cases/box/case.toml:3:12: error: friction cannot be negative\n"
            "  3 | friction = -0.5\n"
            "    |            ^~~~\n"
            "  hint: give a value from 0 to 10");
  EXPECT_EQ(error_of("title = \"a\"\n[contact]\nkn = \"1e13 N/m\"\n"),
            "cases/box/case.toml:3:6: error: kn is too large\n"
            "  3 | kn = \"1e13 N/m\"\n"
            "    |      ^~~~~~~~~~\n"
            "  hint: give a value above 0 N/m and at most 1000000000000 N/m");
  EXPECT_EQ(error_of("title = \"a\"\noutput.every = \"0 s\"\n"),
            "cases/box/case.toml:2:16: error: every cannot be zero\n"
            "  2 | output.every = \"0 s\"\n"
            "    |                ^~~~~\n"
            "  hint: give a value above 0 s");
  EXPECT_EQ(error_of("title = \"a\"\nseed = -1\n"),
            "cases/box/case.toml:2:8: error: seed cannot be negative\n"
            "  2 | seed = -1\n"
            "    |        ^~\n"
            "  hint: give a value at least 0");
}

TEST(Read, UnknownKeyNamesTheNearest) {
  EXPECT_EQ(error_of("title = \"a\"\n[contact]\nfrictoin = 0.5\n"),
            "cases/box/case.toml:3:1: error: frictoin is not a key of contact\n"
            "  3 | frictoin = 0.5\n"
            "    | ^~~~~~~~\n"
            "  hint: did you mean friction? known here: friction, rolling, kn, law");
  EXPECT_EQ(error_of("titel = \"a\"\ntitle = \"a\"\n"),
            "cases/box/case.toml:1:1: error: titel is not a key of this file\n"
            "  1 | titel = \"a\"\n"
            "    | ^~~~~\n"
            "  hint: did you mean title? known here: title, files, seed, sieves, stages, mesh, output, "
            "gravity, contact, "
            "materials, measures");
}

TEST(Read, Units) {
  EXPECT_EQ(error_of("title = \"a\"\n[[stages]]\nkind = \"settle\"\ntime_limit = 5\n"),
            "cases/box/case.toml:4:14: error: time_limit needs a unit: time is given in s, ms, us, min, h\n"
            "  4 | time_limit = 5\n"
            "    |              ^\n"
            "  hint: write for example \"5 s\"");
  EXPECT_EQ(
      error_of("title = \"a\"\n[[stages]]\nkind = \"settle\"\ntime_limit = \"5\"\n"),
      "cases/box/case.toml:4:14: error: time_limit: \"5\" has no unit: a time is given in s, ms, us, min, h\n"
      "  4 | time_limit = \"5\"\n"
      "    |              ^~~\n"
      "  hint: write for example \"5 s\"");
  EXPECT_EQ(error_of("title = \"a\"\n[[stages]]\nkind = \"settle\"\ntime_limit = \"5 kg\"\n"),
            "cases/box/case.toml:4:14: error: time_limit: \"kg\" is not a unit of time: a time is given in "
            "s, ms, us, min, h\n"
            "  4 | time_limit = \"5 kg\"\n"
            "    |              ^~~~~~\n"
            "  hint: write for example \"5 s\"");
}

TEST(Read, WrongType) {
  EXPECT_EQ(error_of("title = 3\n"),
            "cases/box/case.toml:1:9: error: title must be a text, not a whole number\n"
            "  1 | title = 3\n"
            "    |         ^\n"
            "  hint: put it in quotes");
  EXPECT_EQ(error_of("title = \"a\"\nseed = 1.5\n"),
            "cases/box/case.toml:2:8: error: seed must be a whole number, not a number\n"
            "  2 | seed = 1.5\n"
            "    |        ^~~\n"
            "  hint: write for example 3, without point and quotes");
  EXPECT_EQ(error_of("title = \"a\"\ncontact = 1\n"),
            "cases/box/case.toml:2:11: error: contact must be a table, not a whole number\n"
            "  2 | contact = 1\n"
            "    |           ^\n"
            "  hint: begin it with a line [contact]");
  EXPECT_EQ(error_of("title = \"a\"\n[stages]\nkind = \"load\"\n"),
            "cases/box/case.toml:2:1: error: stages must be a list of tables, not a table\n"
            "  2 | [stages]\n"
            "    | ^~~~~~~~\n"
            "  hint: begin each element with a line [[stages]]");
  EXPECT_EQ(error_of("title = \"a\"\ncontact.rolling = \"yes\"\n"),
            "cases/box/case.toml:2:19: error: rolling must be true or false, not a text\n"
            "  2 | contact.rolling = \"yes\"\n"
            "    |                   ^~~~~\n"
            "  hint: write true or false, without quotes");
  EXPECT_EQ(error_of("title = \"a\"\ngravity = [\"0 g\", \"1 g\"]\n"),
            "cases/box/case.toml:2:11: error: gravity must have three entries, not 2\n"
            "  2 | gravity = [\"0 g\", \"1 g\"]\n"
            "    |           ^~~~~~~~~~~~~~\n"
            "  hint: give x, y and z");
  EXPECT_EQ(error_of("title = \"a\"\ncontact.friction = inf\n"),
            "cases/box/case.toml:2:20: error: friction must be a finite number\n"
            "  2 | contact.friction = inf\n"
            "    |                    ^~~");
}

TEST(Read, EntryOfList) {
  EXPECT_EQ(error_of("title = \"a\"\nsieves = [\"1 mm\", \"-2 mm\"]\n"),
            "cases/box/case.toml:2:19: error: an entry of sieves cannot be negative\n"
            "  2 | sieves = [\"1 mm\", \"-2 mm\"]\n"
            "    |                   ^~~~~~~\n"
            "  hint: give a value above 0 m");
  EXPECT_EQ(error_of("title = \"a\"\nmeasures = [\"porosiyt\"]\n"),
            "cases/box/case.toml:2:13: error: an entry of measures cannot be \"porosiyt\"\n"
            "  2 | measures = [\"porosiyt\"]\n"
            "    |             ^~~~~~~~~~\n"
            "  hint: did you mean porosity? known here: porosity, settlement");
}

TEST(Read, MissingRequiredKey) {
  EXPECT_EQ(error_of("seed = 1\n"),
            "cases/box/case.toml: error: title is missing in this file\n"
            "  hint: add title (text): what the case is about");
  EXPECT_EQ(error_of("title = \"a\"\n[materials.ballast]\nfriction = 0.4\n"),
            "cases/box/case.toml:2:1: error: density is missing in materials.ballast\n"
            "  2 | [materials.ballast]\n"
            "    | ^~~~~~~~~~~~~~~~~~~\n"
            "  hint: add density (density [kg/m^3]): of the rock");
}

TEST(Read, Kinds) {
  EXPECT_EQ(error_of("title = \"a\"\n[[stages]]\nkind = \"setle\"\n"),
            "cases/box/case.toml:3:8: error: there is no stage called setle\n"
            "  3 | kind = \"setle\"\n"
            "    |        ^~~~~~~\n"
            "  hint: did you mean settle? known here: settle, cycle, load");
  EXPECT_EQ(error_of("title = \"a\"\n[[stages]]\nname = \"x\"\n"),
            "cases/box/case.toml:2:1: error: kind is missing in stages.0\n"
            "  2 | [[stages]]\n"
            "    | ^~~~~~~~~~\n"
            "  hint: known here: load, cycle, settle");
  EXPECT_EQ(
      error_of("title = \"a\"\nstages = [{ kind = \"cycle\", stages = [{ kind = \"load\", cuont = 3 }] }]\n"),
      "cases/box/case.toml:2:56: error: cuont is not a key of stages.0 (load)\n"
      "  2 | stages = [{ kind = \"cycle\", stages = [{ kind = \"load\", cuont = 3 }] }]\n"
      "    |                                                        ^~~~~\n"
      "  hint: known here: kind, name, force_min, force_max");
}

TEST(Read, RuleBetweenKeys) {
  EXPECT_EQ(
      error_of("title = \"a\"\n[[stages]]\nkind = \"load\"\nforce_min = \"2 kN\"\nforce_max = \"1 kN\"\n"),
      "cases/box/case.toml:5:13: error: force_max must be above force_min\n"
      "  5 | force_max = \"1 kN\"\n"
      "    |             ^~~~~~\n"
      "  hint: force_min is 2000 N");
}

TEST(Read, BrokenToml) {
  EXPECT_EQ(
      error_of("title = \"a\"\nseed = 1\nseed = 2\n"),
      "cases/box/case.toml:3:8: error: in this key-value pair: cannot redefine existing integer 'seed'\n"
      "  3 | seed = 2\n"
      "    |        ^\n"
      "  hint: a key is given once; this one stands above");
  EXPECT_EQ(
      error_of("title = \"a\"\ncontact.kn = 5 kN/m\n"),
      "cases/box/case.toml:2:16: error: in this key-value pair: expected a comment or whitespace, saw 'k'\n"
      "  2 | contact.kn = 5 kN/m\n"
      "    |                ^\n"
      "  hint: a quantity with its unit stands in quotes: \"5 kN\"");
  EXPECT_EQ(error_of("title = \"B\xf6x\"\n"),
            "cases/box/case.toml:1:11: error: this is not UTF-8 text: save the file with the encoding UTF-8\n"
            "  1 | title = \"B?x\"\n"
            "    |           ^");
  EXPECT_EQ(error_of("seed = 5µ\n"),
            "cases/box/case.toml:1:9: error: in this decimal integer: expected digit, saw 'µ'\n"
            "  1 | seed = 5µ\n"
            "    |         ^\n"
            "  hint: a quantity with its unit stands in quotes: \"5 kN\"");
  EXPECT_NE(error_of("[$"), "");
  EXPECT_NE(error_of(std::string("title = \"a\0b\"", 13)), "");
}

TEST(Read, VeryDeepKeyIsRefused) {
  std::string key = "a";
  for (int i = 0; i < 200'000; ++i) key += ".a";
  for (const std::string& text : {key + " = 1\n", "[" + key + "]\n", "x = [{" + key + " = 1}]\n"})
    EXPECT_NE(error_of(text).find("a key of more than 100 parts"), std::string::npos);
  EXPECT_EQ(
      error_of(
          "title = \"a ..................................................................................."
          "........................................\"\n"),
      "");
}

TEST(Read, AllErrorsInOneGo) {
  const std::string message = error_of("sede = 1\n[contact]\nkn = 3\nlaw = \"lienar\"\n");
  EXPECT_NE(message.find("case.toml: error: title is missing"), std::string::npos);
  const std::size_t first = message.find("case.toml:1:1: error: sede"),
                    second = message.find("case.toml:3:6: error: kn"),
                    third = message.find("case.toml:4:7: error: law cannot be \"lienar\"");
  EXPECT_LT(first, second);
  EXPECT_LT(second, third);
  EXPECT_NE(third, std::string::npos);

  std::string many = "title = \"a\"\n";
  for (int i = 0; i < 30; ++i) many += "x" + std::to_string(i) + " = 1\n";
  EXPECT_TRUE(error_of(many).ends_with("... and 10 more errors"));
}

TEST(Read, LongLinesAndTabsAndUmlauts) {
  EXPECT_EQ(
      error_of("\ttitle = \"Körnung\"; x\n"),
      "cases/box/case.toml:1:19: error: in this key-value pair: expected a comment or whitespace, saw ';'\n"
      "  1 |  title = \"Körnung\"; x\n"
      "    |                   ^\n"
      "  hint: a quantity with its unit stands in quotes: \"5 kN\"");
  const std::string message = error_of("title = \"" + std::string(1000, 'a') + "\" x\n");
  EXPECT_NE(message.find("\n    |                                                   ^\n"), std::string::npos)
      << message;
}

TEST(Overrides, ReplaceValues) {
  const Case in = read(sample::good_text, {"seed=9", "contact.law=linear", "stages.rest.time_limit=2 s",
                                           "stages.1.stages.seat.force_max=\"5 kN\"", "sieves=[\"1 mm\"]",
                                           "materials.steel.density=7850 kg/m^3", "output={every=\"1 ms\"}"});
  EXPECT_EQ(in.seed, 9u);
  EXPECT_EQ(in.contact.law, "linear");
  EXPECT_EQ(dynamic_cast<const sample::Settle&>(*in.stages[0].input).time_limit, 2.0);
  const auto& cycle = dynamic_cast<const sample::Cycle&>(*in.stages[1].input);
  EXPECT_EQ(dynamic_cast<const sample::Load&>(*cycle.stages.at(0).input).force_max, 5e3);
  EXPECT_EQ(in.sieves, std::vector<double>{0.001});
  EXPECT_EQ(in.materials.at("steel").density, 7850.0);
  EXPECT_EQ(in.output->every, 0.001);
}

TEST(Overrides, ErrorsNameTheOverride) {
  EXPECT_EQ(error_of(sample::good_text, {"contact.frictoin=0.3"}),
            "--set contact.frictoin=0.3: error: frictoin is not a key of contact\n"
            "  hint: did you mean friction? known here: friction, rolling, kn, law");
  EXPECT_EQ(error_of(sample::good_text, {"contact.friction=-1"}),
            "--set contact.friction=-1: error: friction cannot be negative\n"
            "  hint: give a value from 0 to 10");
  EXPECT_EQ(error_of(sample::good_text, {"stages.5.time_limit=1 s"}),
            "--set stages.5.time_limit=1 s: error: stages has no element 5\n"
            "  hint: elements are counted from 0 to 1; known here: rest, cycle");
  EXPECT_EQ(error_of(sample::good_text, {"stages.resst.time_limit=1 s"}),
            "--set stages.resst.time_limit=1 s: error: stages has no element resst\n"
            "  hint: elements are counted from 0 to 1; did you mean rest? known here: rest, cycle");
  EXPECT_EQ(error_of(sample::good_text, {"seed"}),
            "--set seed: error: there is no =\n"
            "  hint: write --set key=value, for example --set seed=3");
  EXPECT_EQ(error_of(sample::good_text, {"seed="}),
            "--set seed=: error: there is no value after =\n"
            "  hint: for example --set seed=3 or --set 'time=\"2 s\"'");
  EXPECT_EQ(error_of(sample::good_text, {"seed.x=1"}),
            "--set seed.x=1: error: seed is not a table: it has no x");
  EXPECT_EQ(error_of(sample::good_text, {".=1"}),
            "--set .=1: error: \".\" is not a key\n"
            "  hint: for example --set stages.2.time=\"2 s\"");
  EXPECT_EQ(error_of(sample::good_text, {"sieves=[1"}),
            "--set sieves=[1: error: the value is not TOML: in this array: encountered end-of-file\n"
            "  hint: for example --set seed=3 or --set 'time=\"2 s\"'");
  EXPECT_EQ(error_of(sample::good_text, {"mesh=none.stl"}),
            "--set mesh=none.stl: error: mesh: there is no file \"none.stl\"\n"
            "  hint: looked for none.stl: names start from the folder where the program is started");
}

TEST(Read, ErrorsFoundLaterPointAtTheKey) {
  const Document document = Document::from_text(sample::good_text, "case.toml", {"stages.0.name=first"});
  const auto message = [&](std::string_view key) -> std::string {
    try {
      document.fail(key, "there is no such wall", "known are a, b");
    } catch (const InputError& error) {
      return error.what();
    }
  };
  EXPECT_EQ(message("stages.1.stages.0.force_max"),
            "case.toml:22:55: error: there is no such wall\n"
            "  22 | stages = [{ kind = \"load\", name = \"seat\", force_max = \"20 kN\" }]\n"
            "     |                                                       ^~~~~~~\n"
            "  hint: known are a, b");
  EXPECT_EQ(message("stages.0.name"),
            "--set stages.0.name=first: error: there is no such wall\n  hint: known are a, b");
  EXPECT_EQ(message("nothing.here"), "case.toml: error: there is no such wall\n  hint: known are a, b");
}

class ReadPaths : public ::testing::Test {
 protected:
  void SetUp() override {
    std::filesystem::create_directories(folder_ / "stones");
    for (const char* name : {"b.obj", "a.obj", "c.stl"}) std::ofstream(folder_ / "stones" / name) << "x";
  }

  std::string error_of_file(const std::string& text) {
    std::ofstream(folder_ / "case.toml") << text;
    try {
      input_ = read_input<Case>(folder_ / "case.toml");
    } catch (const InputError& error) {
      return error.what();
    }
    return {};
  }

  TemporaryFolder temporary_;
  std::filesystem::path folder_ = temporary_.path / "case [1]";
  Case input_;
};

TEST_F(ReadPaths, PatternsAreExpandedInOrder) {
  EXPECT_EQ(
      error_of_file("title = \"a\"\nfiles = [\"stones/*.obj\", \"stones/c.stl\"]\nmesh = \"stones/c.stl\"\n"),
      "");
  const std::filesystem::path stones = folder_ / "stones";
  EXPECT_EQ(input_.files, (std::vector{stones / "a.obj", stones / "b.obj", stones / "c.stl"}));
  EXPECT_EQ(input_.mesh, stones / "c.stl");
}

TEST_F(ReadPaths, MissingFiles) {
  const std::string file = (folder_ / "case.toml").string();
  EXPECT_EQ(error_of_file("title = \"a\"\nfiles = \"stones/*.ply\"\n"),
            file +
                ":2:9: error: files: no file matches \"stones/*.ply\"\n"
                "  2 | files = \"stones/*.ply\"\n"
                "    |         ^~~~~~~~~~~~~~\n"
                "  hint: looked for " +
                (folder_ / "stones/*.ply").string() + ": names start from the folder of the input file");
  EXPECT_EQ(error_of_file("title = \"a\"\nmesh = \"/no/such.stl\"\n"),
            file +
                ":2:8: error: mesh: there is no file \"/no/such.stl\"\n"
                "  2 | mesh = \"/no/such.stl\"\n"
                "    |        ^~~~~~~~~~~~~~\n"
                "  hint: give a file that exists");
  EXPECT_THROW(read_input<Case>(folder_ / "none.toml"), InputError);
  EXPECT_THROW(read_input<Case>(folder_), InputError);
}

}  // namespace
}  // namespace trackbed
