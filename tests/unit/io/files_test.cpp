#include "io/files.h"

#include <gtest/gtest.h>

#include "base/error.h"
#include "scenes/temporary_folder.h"

namespace trackbed {
namespace {

namespace fs = std::filesystem;

class Files : public ::testing::Test {
 protected:
  TemporaryFolder temporary_;
  fs::path folder_ = temporary_.path;
  void SetUp() override { make_folder(folder_ / "a" / "b"); }
};

TEST_F(Files, WhatIsWrittenIsRead) {
  const std::string bytes("x\0\r\ny\xff", 6);
  write_file(folder_ / "f", bytes);
  EXPECT_EQ(read_file(folder_ / "f"), bytes);
  write_file(folder_ / "f", "shorter");
  EXPECT_EQ(read_file(folder_ / "f"), "shorter");
  write_file(folder_ / "f", {"in ", "", "parts"});
  EXPECT_EQ(read_file(folder_ / "f"), "in parts");
  // Nothing but the file is left: no drafts.
  EXPECT_EQ(std::distance(fs::directory_iterator(folder_), fs::directory_iterator()), 2);
}

TEST_F(Files, ErrorsNameTheFile) {
  const auto message = [](const auto& action) -> std::string {
    try {
      action();
    } catch (const std::exception& error) {
      return error.what();
    }
    return {};
  };
  const std::string at = folder_.string();
  EXPECT_EQ(message([&] { read_file(folder_ / "none"); }),
            at + "/none: cannot be opened: No such file or directory");
  EXPECT_EQ(message([&] { read_file(folder_ / "a"); }), at + "/a: this is a folder, a file is needed");
  EXPECT_EQ(message([&] { write_file(folder_ / "none" / "f", "x"); }),
            at + "/none/f: cannot be written: No such file or directory");
  EXPECT_EQ(message([&] { write_file(folder_ / "a", "x"); }),
            at + "/a: cannot be put in place: Is a directory");
  write_file(folder_ / "big", std::string(2'000'001, 'x'));
  EXPECT_EQ(message([&] { read_file(folder_ / "big", 2'000'000); }),
            at + "/big: the file is larger than 2 MB");
  EXPECT_EQ(message([&] { make_folder(folder_ / "big" / "x"); }),
            at + "/big/x: the folder cannot be made: Not a directory");
}

TEST_F(Files, PatternsInOrder) {
  for (const char* name : {"b.obj", "B.obj", "a10.obj", "a2.obj", ".hidden.obj", "c.stl"})
    write_file(folder_ / name, "x");
  write_file(folder_ / "a" / "d.obj", "x");
  const std::vector<fs::path> expected = {folder_ / "B.obj", folder_ / "a10.obj", folder_ / "a2.obj",
                                          folder_ / "b.obj"};
  EXPECT_EQ(expand_pattern(folder_ / "*.obj"), expected);
  EXPECT_EQ(expand_pattern(folder_ / "*" / "*.obj"), std::vector<fs::path>{folder_ / "a" / "d.obj"});
  EXPECT_EQ(expand_pattern(folder_ / "[bc].*"),
            (std::vector<fs::path>{folder_ / "b.obj", folder_ / "c.stl"}));
  EXPECT_TRUE(expand_pattern(folder_ / "*.ply").empty());
  EXPECT_TRUE(is_pattern("a*.obj"));
  EXPECT_FALSE(is_pattern("a.obj"));
}

}  // namespace
}  // namespace trackbed
