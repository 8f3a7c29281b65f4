#include "lab/study/foreseen.h"

#include <algorithm>
#include <iterator>
#include <string_view>

#include <fmt/format.h>

#include "io/nearest.h"
#include "lab/measure.h"
#include "lab/track/track_case.h"

namespace trackbed {
namespace {

/// Whether a name is the one that was foreseen, some number in the place of NUMBER.
bool fits(std::string_view name, std::string_view foreseen) {
  constexpr std::string_view number = "NUMBER";
  const std::size_t at = foreseen.find(number);
  if (at == std::string_view::npos) return name == foreseen;
  const std::string_view before = foreseen.substr(0, at), behind = foreseen.substr(at + number.size());
  if (name.size() <= before.size() + behind.size() || !name.starts_with(before) || !name.ends_with(behind))
    return false;
  const std::string_view there = name.substr(at, name.size() - before.size() - behind.size());
  return there.find_first_not_of("0123456789.+-e") == std::string_view::npos;
}

/// What is measured at the end of every stage. Walls and bodies are named only: their shapes do not matter.
std::vector<std::string> general_measures(const CaseInput& in) {
  Simulation sim;
  sim.force_limits = in.record.force_bins;
  for (const auto& [name, wall] : in.walls) wall.input->build(name, 0, sim);
  for (const auto& [name, body] : in.bodies) add_body_by_name(sim, name);
  std::vector<std::string> names;
  for (const Measure& m : measures_of(sim)) names.push_back(m.name);
  return names;
}

std::vector<std::string> measures_of_run(const CaseInput& in) {
  const std::vector<std::string> general = general_measures(in);
  std::vector<std::string> names = general;
  for (const OneOf<StageInput>& stage : in.stages) {
    const std::string prefix = stage.input->name + ".";
    for (const Foreseen& result : foreseen_results(stage)) names.push_back(prefix + result.name);
    for (const std::string& name : general) names.push_back(prefix + name);
  }
  return names;
}

}  // namespace

ForeseenMeasures::ForeseenMeasures(const CaseInput& run) : names_(measures_of_run(run)) {}

ForeseenMeasures::ForeseenMeasures(const StudyInput& study, const std::vector<Condition>& conditions) {
  for (const Condition& condition : conditions) {
    const Document document(study.base, changes_of(study, condition));
    all_pass_ = is_track_case(document);
    if (all_pass_) return;
    CaseInput in;
    document.read(in);
    std::ranges::move(measures_of_run(in), std::back_inserter(names_));
  }
  std::ranges::sort(names_);
  names_.erase(std::unique(names_.begin(), names_.end()), names_.end());
}

std::optional<std::string> ForeseenMeasures::hint_for(const std::string& name) const {
  if (all_pass_ || std::ranges::any_of(names_, [&](const auto& foreseen) { return fits(name, foreseen); }))
    return std::nullopt;
  return known_words(name, names_, few_words);
}

void check_measures(const Document& document, const StudyInput& study, const ForeseenMeasures& foreseen) {
  const auto check = [&](const std::string& key, const std::string& name) {
    if (const auto hint = foreseen.hint_for(name))
      document.fail(key, fmt::format("no run leaves a measure called {}", name), *hint);
  };
  for (const std::string& name : study.measures) check("measures", name);
  for (std::size_t k = 0; k < study.fits.size(); ++k) check(fmt::format("fits.{}.y", k), study.fits[k].y);
}

}  // namespace trackbed
