#include "io/csv.h"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

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
