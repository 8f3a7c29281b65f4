#include "io/csv.h"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <cmath>
#include <cstdlib>
#include <limits>

#include "base/error.h"
#include "io/files.h"
#include "scenes/temporary_folder.h"

namespace trackbed {
namespace {

class Csv : public ::testing::Test {
 protected:
  TemporaryFolder folder_;
  std::filesystem::path path_ = folder_.path / "table.csv";
  std::vector<Column> columns_ = {
      {"time", Dimension::time}, {"sleeper, force", Dimension::force}, {"porosity"}};
};

TEST_F(Csv, UnitsInTheHeaderAndShortNumbers) {
  CsvWriter table(path_, columns_);
  table.add_row({0.1, 2e4, 1.0 / 3.0});
  table.add_row({1e-20, -0.0, 1e300});
  const std::string expected =
      "time [s],\"sleeper, force [N]\",porosity [-]\n0.1,20000,0.3333333333333333\n1e-20,-0,1e+300\n";
  EXPECT_EQ(read_file(path_), expected);  // while the writer is open: every row is there at once
  EXPECT_EQ(table.rows(), 2u);
}

TEST_F(Csv, NumbersReadBackToTheSameBits) {
  rc::check([this](double value) {
    {
      CsvWriter table(path_, {{"x"}});
      table.add_row({value});
    }
    const std::string text = read_file(path_).substr(6);
    const double back = std::strtod(text.c_str(), nullptr);
    RC_ASSERT(back == value);
  });
}

TEST_F(Csv, ATableIsReadByNamesAndUnits) {
  write_file(path_,
             "time [ms],\"sleeper, force [kN]\", stage,share [-],plain\r\n1,2.5,\"a "
             "\"\"b\"\"\",0.5,7\r\n\r\n2,-1e-3,c,nan,8\r\n");
  const CsvTable table(path_);
  EXPECT_EQ(table.rows(), 2u);
  EXPECT_EQ(table.numbers("time", Dimension::time), (std::vector<double>{1e-3, 2e-3}));
  EXPECT_EQ(table.numbers("sleeper, force", Dimension::force), (std::vector<double>{2500, -1}));
  EXPECT_EQ(table.texts("stage"), (std::vector<std::string>{"a \"b\"", "c"}));
  EXPECT_EQ(table.numbers("share", Dimension::none)[0], 0.5);
  EXPECT_TRUE(std::isnan(table.numbers("share", Dimension::none)[1]));
  EXPECT_EQ(table.numbers("plain", Dimension::mass), (std::vector<double>{7, 8}));
  EXPECT_FALSE(table.has("x"));
}

TEST_F(Csv, WhatIsNoSuchTableIsRefused) {
  const auto message = [&](const std::string& text, const auto& use) -> std::string {
    write_file(path_, text);
    try {
      use(CsvTable(path_));
    } catch (const InputError& error) {
      return error.what();
    }
    return "nothing wrong";
  };
  const auto nothing = [](const CsvTable&) {};
  const auto forces = [](const CsvTable& t) { t.numbers("force", Dimension::force); };
  EXPECT_NE(message("", nothing).find("there is no table in it"), std::string::npos);
  EXPECT_NE(message("a,b\n1\n", nothing).find("table.csv:2: 1 fields under 2 headings"), std::string::npos);
  EXPECT_NE(message("forse [N]\n1\n", forces).find("did you mean forse?"), std::string::npos);
  EXPECT_NE(message("force [m]\n1\n", forces).find("the column force: "), std::string::npos);
  EXPECT_NE(message("force [N]\n1 N\n", forces).find("no number in row 1 of the column force"),
            std::string::npos);
}

TEST_F(Csv, ResumeDropsWhatCameAfterTheCheckpoint) {
  {
    CsvWriter table(path_, columns_);
    for (int i = 0; i < 5; ++i) table.add_row({double(i), 0, 0});
  }
  {
    CsvWriter table = CsvWriter::resume(path_, columns_, 2);
    EXPECT_EQ(table.rows(), 2u);
    table.add_row({7, 0, 0});
  }
  EXPECT_EQ(read_file(path_), "time [s],\"sleeper, force [N]\",porosity [-]\n0,0,0\n1,0,0\n7,0,0\n");
  EXPECT_THROW(CsvWriter::resume(path_, columns_, 4), RunError);
  EXPECT_THROW(CsvWriter::resume(path_, {{"other"}}, 0), RunError);
}

TEST_F(Csv, FullDiskIsAnErrorThatNamesTheFile) {
  if (!std::filesystem::exists("/dev/full")) GTEST_SKIP() << "this system has no /dev/full";
  try {
    CsvWriter table("/dev/full", columns_);
    FAIL();
  } catch (const RunError& error) {
    EXPECT_STREQ(error.what(), "/dev/full: cannot be written: No space left on device");
  }
}

TEST_F(Csv, WrongNumberOfValuesIsRefused) {
  CsvWriter table(path_, columns_);
  EXPECT_THROW(table.add_row({1.0}), std::logic_error);
}

}  // namespace
}  // namespace trackbed
