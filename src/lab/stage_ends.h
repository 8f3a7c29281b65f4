// Ends of stages, kept for other runs that begin alike: a bed is built once, and loaded in many ways.
#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <string_view>

#include "dem/model.h"

namespace trackbed {

class StageEnds {
 public:
  /// In `folder`; empty: nothing is kept. `input` is the resolved case, whose record.keep names the stages.
  StageEnds(std::filesystem::path folder, const nlohmann::ordered_json& input, const Model& model);

  /// Whether the end of the stage of this name is to be kept and is not yet.
  bool wants(const std::string& stage) const;

  /// Keeps it. Throws RunError.
  void write(const std::string& stage, std::string_view bytes) const;

  /// The bytes of an end that a run left which was the same up to it, by the same program; else nothing.
  std::optional<std::string> find(const std::string& stage) const;

 private:
  bool is_kept(const std::string& stage) const;
  /// The input as far as it has to do with the stages up to this one.
  nlohmann::ordered_json up_to(const std::string& stage) const;
  /// All that decides how the stage ends.
  std::string what_decides(const std::string& stage) const;
  std::filesystem::path file_of(const std::string& what) const;

  std::filesystem::path folder_;
  nlohmann::ordered_json input_;
  std::uint64_t shapes_ = 0, program_ = 0;
};

}  // namespace trackbed
