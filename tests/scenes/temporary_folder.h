// A place for the files of a test.
#pragma once

#include <unistd.h>

#include <filesystem>
#include <string>

#include <gtest/gtest.h>

namespace trackbed {

/// An empty folder of the running test's own, removed with all that is in it.
struct TemporaryFolder {
  const std::filesystem::path path = [] {
    const auto* test = ::testing::UnitTest::GetInstance()->current_test_info();
    return std::filesystem::temp_directory_path() / (std::string("trackbed.") + test->test_suite_name() +
                                                     "." + test->name() + "." + std::to_string(::getpid()));
  }();
  TemporaryFolder() { std::filesystem::create_directories(path); }
  ~TemporaryFolder() {
    std::error_code ignored;  // a folder that stays does not fail a test
    std::filesystem::remove_all(path, ignored);
  }
  TemporaryFolder(const TemporaryFolder&) = delete;
  TemporaryFolder& operator=(const TemporaryFolder&) = delete;
};

}  // namespace trackbed
