// Ends of stages, kept for other runs that begin alike: a bed is built once, and loaded in many ways.
#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>

#include "base/archive.h"
#include "dem/model.h"

namespace trackbed {

/// Of stones and walls, whose files may have changed while their names stayed.
std::uint64_t hash_of_shapes(const Model& model);

class StageEnds {
 public:
  /// In `folder`; empty: nothing is kept. `input` is the resolved case, whose record.keep names the stages.
  StageEnds(std::filesystem::path folder, const nlohmann::ordered_json& input, const Model& model);

  /// An archive to which the end of the stage of this name is to be written; nothing when it is not to be
  /// kept, or is already.
  std::optional<Archive> begin(const std::string& stage) const;

  /// Keeps what was written to it. Throws RunError.
  void keep(const std::string& stage, const Archive& end) const;

  /// An archive that reads an end which a run left that was the same up to it, by the same program; else
  /// nothing.
  std::optional<Archive> find(const std::string& stage) const;

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
