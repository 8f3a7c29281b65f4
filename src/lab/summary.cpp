#include "lab/summary.h"

#include <fmt/format.h>

#include "base/units.h"
#include "io/files.h"

namespace trackbed {
namespace {

using Json = nlohmann::ordered_json;

Json quantity(double value, Dimension dimension) {
  return {{"value", value}, {"unit", si_unit_of(dimension)}};
}

Json named(const std::vector<Result>& results) {
  Json object = Json::object();
  for (const Result& r : results) object[r.name] = quantity(r.value, r.dimension);
  return object;
}

Json to_json(const StageSummary& stage) {
  Json object = {{"name", stage.name},
                 {"kind", stage.kind},
                 {"steps", stage.steps},
                 {"simulated_s", stage.simulated},
                 {"wall_s", stage.wall},
                 {"steps_per_s", stage.wall > 0 ? static_cast<double>(stage.steps) / stage.wall : 0.0},
                 {"energy_error", quantity(stage.energy_error, Dimension::energy)},
                 {"results", named(stage.results)},
                 {"measures", named(stage.measures)}};
  if (stage.taken_over) object["taken_over"] = true;
  return object;
}

}  // namespace

std::string hash_text(std::uint64_t hash) {
  return fmt::format("0x{:016x}", hash);
}

Json to_json(const Summary& summary) {
  Json stages = Json::array();
  for (const StageSummary& stage : summary.stages) stages.push_back(to_json(stage));
  return {{"title", summary.title},
          {"version", TRACKBED_VERSION},
          {"seed", summary.seed},
          {"threads", summary.threads},
          {"wall_s", summary.wall},
          {"state_hash", hash_text(summary.state_hash)},
          {"measures", named(summary.measures)},
          {"force_histogram",
           {{"limits", summary.force_limits}, {"unit", "N"}, {"counts", summary.force_counts}}},
          {"stages", std::move(stages)},
          {"input", summary.input}};
}

void write_summary(const Summary& summary, const std::filesystem::path& path) {
  write_file(path, to_json(summary).dump(2) + '\n');
}

}  // namespace trackbed
