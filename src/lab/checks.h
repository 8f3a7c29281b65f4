// What is wrong with a case and cannot be seen from one key alone, said before the first step.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "io/read.h"
#include "lab/case.h"

namespace trackbed {

/// Whether a name may become part of file names, of columns, and of keys with dots: letters, digits, - and _.
bool is_plain_name(std::string_view name);
inline constexpr const char* plain_name_hint = "use letters, digits, - and _ only";

/// "there is no body called slepper", at a key of the case, with the nearest of the names there are.
[[noreturn]] void refuse_unknown(const Document& document, const std::string& key, std::string_view what,
                                 const std::string& name, const std::vector<std::string>& known);

/// Refuse a name that is no body, or no wall, of the simulation.
void check_body(const Document& document, const Simulation& sim, const std::string& key,
                const std::string& name);
void check_wall(const Document& document, const Simulation& sim, const std::string& key,
                const std::string& name);

/// Refuse a name that is no set of stones, or no region, of the case.
void check_stone_set(const Document& document, const CaseInput& experiment, const std::string& key,
                     const std::string& name);
void check_region(const Document& document, const CaseInput& experiment, const std::string& key,
                  const std::string& name);

/// Refuse a name that is no measure.
void check_measures(const Document& document, const Simulation& sim, const std::string& key,
                    const std::vector<std::string>& names);

/// Which walls and bodies are there, as one stage follows the other.
class Presence {
 public:
  explicit Presence(const Simulation& sim);
  void put(const std::string& name) { is_there_[index(name)] = true; }
  void take_away(const std::string& name) { is_there_[index(name)] = false; }
  /// Refuses, at a key of the case, a wall or body that is not there.
  void check(const Document& document, const std::string& key, const std::string& name) const;

 private:
  std::size_t index(const std::string& name) const { return static_cast<std::size_t>(sim_.find_wall(name)); }
  const Simulation& sim_;
  std::vector<bool> is_there_;
};

/// Names of walls and bodies: plain, and each once. There is one container at most, or trays.
void check_names(const Document& document, const CaseInput& experiment);

/// Names of the stages of one list: each once; then all that the stages themselves know (StageInput::check).
void check_stage_list(const Document& document, const std::vector<OneOf<StageInput>>& stages,
                      const CaseInput& experiment, const Simulation& sim);

/// The stages of the case, what they act on, and the names of those that are recorded.
void check_stages(const Document& document, const CaseInput& experiment, const Simulation& sim);

/// What must be so in a model of two dimensions: walls stand on the plane and reach through the thickness.
void check_plane(const Document& document, const CaseInput& experiment, const Simulation& sim);

/// Refuses a vector out of the plane, in a model of two dimensions.
void check_in_plane(const Document& document, const Simulation& sim, const std::string& key,
                    const Vec3& vector);

/// A time step of the user's own must suit the smallest stone of the grading.
void check_time_step(const Document& document, const CaseInput& experiment, const Simulation& sim);

}  // namespace trackbed
