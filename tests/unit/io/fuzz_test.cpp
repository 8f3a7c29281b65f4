// Damaged input files: whatever stands in them, the answer is a case or an InputError.
#include <gtest/gtest.h>

#include "base/error.h"
#include "base/rng.h"
#include "io/read.h"
#include "sample_input.h"

namespace trackbed {
namespace {

/// Deletes, doubles, swaps and replaces bytes and pieces of the text.
std::string damage(std::string text, Rng& rng) {
  static const std::vector<std::string> pieces = {"[",
                                                  "]",
                                                  "[[",
                                                  "]]",
                                                  "{",
                                                  "}",
                                                  "\"",
                                                  "'",
                                                  "=",
                                                  ".",
                                                  ",",
                                                  "\n",
                                                  "#",
                                                  "\\u",
                                                  "\xff",
                                                  "\xc3",
                                                  "\u00b5",
                                                  "\u3000",
                                                  "-1",
                                                  "nan",
                                                  "inf",
                                                  "1e9",
                                                  "true",
                                                  "\"5 s\"",
                                                  "\"\"\"",
                                                  "stages",
                                                  "kind",
                                                  "1979-05-27",
                                                  "0x",
                                                  "_",
                                                  std::string(1, '\0')};
  const auto position = [&] { return rng.index(static_cast<std::uint32_t>(text.size() + 1)); };
  const std::uint32_t times = 1 + rng.index(6);
  for (std::uint32_t i = 0; i < times; ++i) {
    const std::size_t at = position();
    const std::size_t length = rng.index(12);
    switch (rng.index(5)) {
      case 0:
        text.erase(at, length);
        break;
      case 1:
        text.insert(at, pieces[rng.index(static_cast<std::uint32_t>(pieces.size()))]);
        break;
      case 2:
        text.insert(position(), text.substr(at, length * 4));
        break;
      case 3:
        if (at < text.size()) text[at] = static_cast<char>(rng.index(256));
        break;
      default:
        text.replace(at, std::min(length, text.size() - at),
                     pieces[rng.index(static_cast<std::uint32_t>(pieces.size()))]);
    }
  }
  return text;
}

TEST(Fuzz, DamagedFilesAreReadOrRefused) {
  Rng rng(1, "damaged files");
  int refused = 0;
  for (int i = 0; i < 20'000; ++i) {
    const std::string text = damage(sample::good_text, rng);
    try {
      sample::Case input;
      Document::from_text(text, "case.toml").read(input);
    } catch (const InputError& error) {
      ++refused;
      ASSERT_NE(std::string(error.what()), "") << text;
    }
  }
  EXPECT_GT(refused, 10'000);  // most damage is noticed
  EXPECT_LT(refused, 20'000);
}

TEST(Fuzz, DamagedOverridesAreTakenOrRefused) {
  Rng rng(2, "damaged overrides");
  const std::vector<std::string> good = {"stages.rest.time_limit=\"2 s\"", "contact={kn=\"3 N/m\"}", "seed=4",
                                         "stages.1.stages.seat.force_max=5 kN",
                                         "materials.a.density=1 kg/m3"};
  for (int i = 0; i < 20'000; ++i) {
    const std::string text = damage(good[rng.index(static_cast<std::uint32_t>(good.size()))], rng);
    try {
      sample::Case input;
      Document::from_text(sample::good_text, "case.toml", {text}).read(input);
    } catch (const InputError& error) {
      ASSERT_TRUE(std::string(error.what()).starts_with("--set ") ||
                  std::string(error.what()).starts_with("case.toml"))
          << error.what();
    }
  }
}

}  // namespace
}  // namespace trackbed
