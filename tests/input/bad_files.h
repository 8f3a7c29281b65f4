// A folder of wrong input files, each beside the exact message it must give: NAME.toml and NAME.txt. Lines
// "# --set key=value" at the top of a file are overrides.
#pragma once

#include <gtest/gtest.h>

#include <filesystem>
#include <functional>
#include <sstream>
#include <string>
#include <vector>

#include "base/error.h"
#include "io/files.h"
#include "io/read.h"

namespace trackbed {

inline std::vector<std::string> overrides_in(const std::string& text) {
  constexpr std::string_view mark = "# --set ";
  std::vector<std::string> overrides;
  std::istringstream lines(text);
  for (std::string line; std::getline(lines, line) && line.starts_with(mark);)
    overrides.push_back(line.substr(mark.size()));
  return overrides;
}

/// Reads every file of the folder as an Input, then uses it. The folder is the current one meanwhile: files
/// are named without it in the messages.
template <class Input>
void expect_messages(const std::filesystem::path& folder,
                     const std::function<void(const Document&, const Input&)>& use = {}) {
  const std::filesystem::path before = std::filesystem::current_path();
  std::filesystem::current_path(folder);
  const std::vector<std::filesystem::path> files = expand_pattern("*.toml");
  ASSERT_FALSE(files.empty()) << folder;
  for (const std::filesystem::path& file : files) {
    const std::string text = read_file(file);
    const std::string expected = read_file(std::filesystem::path(file).replace_extension(".txt"));
    std::string message = "no error\n";
    try {
      Input input;
      const Document document = Document::from_text(text, file.filename(), overrides_in(text));
      document.read(input);
      if (use) use(document, input);
    } catch (const InputError& error) {
      message = std::string(error.what()) + '\n';
    }
    EXPECT_EQ(message, expected) << file;
  }
  std::filesystem::current_path(before);
}

}  // namespace trackbed
