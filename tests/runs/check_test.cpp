// `trackbed check` of every file that ships, and of one that is wrong.
#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>

#include "io/files.h"
#include "scenes/temporary_folder.h"

namespace trackbed {
namespace {

namespace fs = std::filesystem;

struct Checked {
  int code;
  std::string told;
};

Checked check(const fs::path& file, const std::string& more = {}) {
  const TemporaryFolder folder;
  const fs::path out = folder.path / "told.txt";
  const std::string command = std::string(TRACKBED_PROGRAM) + " check '" + file.string() + "' " + more +
                              " > '" + out.string() + "' 2>&1";
  const int status = std::system(command.c_str());
  return {WEXITSTATUS(status), read_file(out)};
}

TEST(Check, KnowsEveryStudyRuleAndCouplingThatShips) {
  int files = 0;
  for (const fs::path& file : expand_pattern(fs::path(TRACKBED_ROOT) / "cases/*/*.toml")) {
    if (file.filename() == "expected.toml" || file.filename() == "case.toml")
      continue;  // other tests read them
    const Checked checked = check(file);
    EXPECT_EQ(checked.code, 0) << file << '\n' << checked.told;
    EXPECT_NE(checked.told.find("nothing is wrong with"), std::string::npos) << file;
    ++files;
  }
  EXPECT_GE(files, 8);
}

TEST(Check, TellsTheRunsOfAStudy) {
  const Checked checked = check(fs::path(TRACKBED_ROOT) / "cases/wedge-2d/study.toml", "--set repeats=2");
  EXPECT_EQ(checked.code, 0) << checked.told;
  EXPECT_NE(checked.told.find("runs          10, of 2 seeds from 1"), std::string::npos) << checked.told;
}

TEST(Check, NamesAWrongKeyOfAStudy) {
  const Checked checked = check(fs::path(TRACKBED_ROOT) / "cases/wedge-2d/study.toml", "--set repeat=2");
  EXPECT_EQ(checked.code, 2);
  EXPECT_NE(checked.told.find("repeat is not a key"), std::string::npos) << checked.told;
}

}  // namespace
}  // namespace trackbed
