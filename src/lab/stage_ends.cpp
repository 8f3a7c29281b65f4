#include "lab/stage_ends.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>
#include <vector>

#include "base/hash.h"
#include "io/files.h"
#include "lab/checkpoint.h"

namespace trackbed {
namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;
namespace {

/// Another build may round otherwise.
std::uint64_t hash_of_program() {
  Hash hash;
  hash.add(std::string_view(read_file("/proc/self/exe")));
  return hash.value();
}

/// Whether it names a file whose content the input does not tell.
bool names_a_file(const Json& part) {
  if (part.is_object())
    for (const char* key : {"file", "levels_from"})
      if (part.contains(key)) return true;
  return part.is_structured() && std::ranges::any_of(part, names_a_file);
}

}  // namespace

std::uint64_t hash_of_shapes(const Model& model) {
  Hash hash;
  const auto add = [&](const Vec3& v) {
    for (const double x : v) hash.add(x);
  };
  for (const ClumpTemplate& t : model.templates) {
    hash.add(t.volume);
    add(t.inertia);
    for (const Pebble& pebble : t.pebbles) {
      add(pebble.centre);
      hash.add(pebble.radius);
    }
  }
  for (const Wall& wall : model.walls)
    for (const Vec3& v : wall.shape.mesh.vertices) add(v);
  return hash.value();
}

StageEnds::StageEnds(fs::path folder, const Json& input, const Model& model)
    : folder_(std::move(folder)), input_(input) {
  if (folder_.empty()) return;
  if (input_["record"]["keep"].empty()) {
    folder_.clear();
    return;
  }
  shapes_ = hash_of_shapes(model);
  program_ = hash_of_program();
}

bool StageEnds::is_kept(const std::string& stage) const {
  if (folder_.empty()) return false;
  const auto names = input_["record"]["keep"].get<std::vector<std::string>>();
  if (std::ranges::find(names, stage) == names.end()) return false;
  const Json begin = up_to(stage);
  return !names_a_file(begin["regions"]) && !names_a_file(begin["stages"]);
}

Json StageEnds::up_to(const std::string& stage) const {
  Json what = input_;
  what.erase("title");
  what["record"] = {{"force_bins", input_["record"]["force_bins"]}};  // measures of stages are named by them
  Json& stages = what["stages"];
  const auto last = std::ranges::find_if(stages, [&](const Json& s) { return s["name"] == stage; });
  stages.erase(last + 1, stages.end());
  return what;
}

std::string StageEnds::what_decides(const std::string& stage) const {
  return fmt::format("{:016x} {:016x} {}", program_, shapes_, up_to(stage).dump());
}

fs::path StageEnds::file_of(const std::string& what) const {
  Hash hash;
  hash.add(std::string_view(what));
  return folder_ / fmt::format("{:016x}.end", hash.value());
}

// What decides comes first: two of them may have one hash.

std::optional<Archive> StageEnds::begin(const std::string& stage) const {
  if (!is_kept(stage)) return std::nullopt;
  std::string what = what_decides(stage);
  if (fs::exists(file_of(what))) return std::nullopt;
  Archive end;
  end(what);
  return end;
}

void StageEnds::keep(const std::string& stage, const Archive& end) const {
  make_folder(folder_);
  write_checked(file_of(what_decides(stage)), end.bytes());
}

std::optional<Archive> StageEnds::find(const std::string& stage) const {
  if (!is_kept(stage)) return std::nullopt;
  const std::string wanted = what_decides(stage);
  auto bytes = read_checked(file_of(wanted));
  if (!bytes) return std::nullopt;
  Archive end(std::move(*bytes));
  std::string what;
  end(what);
  if (what != wanted) return std::nullopt;
  return end;
}

}  // namespace trackbed
