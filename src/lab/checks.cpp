#include "lab/checks.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <limits>
#include <map>

#include "dem/step.h"
#include "io/nearest.h"
#include "lab/grading.h"
#include "lab/measure.h"

namespace trackbed {
namespace {

std::vector<std::string> names_of(const Simulation& sim, bool bodies) {
  std::vector<std::string> names;
  for (const Wall& wall : sim.model.walls)
    if (wall.body.has_value() == bodies) names.push_back(wall.shape.name);
  return names;
}

void check_plain(const Document& document, const std::string& table, const std::string& name) {
  if (!is_plain_name(name))
    document.fail(table + "." + name, fmt::format("\"{}\" cannot be a name in {}", name, table),
                  plain_name_hint);
}

}  // namespace

bool is_plain_name(std::string_view name) {
  return !name.empty() && std::ranges::all_of(name, [](unsigned char c) {
    return c < 0x80 && (std::isalnum(c) || c == '-' || c == '_');
  });
}

void refuse_unknown(const Document& document, const std::string& key, std::string_view what,
                    const std::string& name, const std::vector<std::string>& known) {
  document.fail(key, fmt::format("there is no {} called {}", what, name),
                known.empty() ? fmt::format("the case has no {}", what) : known_words(name, known));
}

void check_body(const Document& document, const Simulation& sim, const std::string& key,
                const std::string& name) {
  const std::vector<std::string> known = names_of(sim, true);
  if (std::ranges::find(known, name) == known.end()) refuse_unknown(document, key, "body", name, known);
}

void check_wall(const Document& document, const Simulation& sim, const std::string& key,
                const std::string& name) {
  const std::vector<std::string> known = names_of(sim, false);
  if (std::ranges::find(known, name) == known.end()) refuse_unknown(document, key, "wall", name, known);
}

void check_stone_set(const Document& document, const CaseInput& in, const std::string& key,
                     const std::string& name) {
  if (in.stones.sets.contains(name)) return;
  std::vector<std::string> known;
  for (const auto& [other, set] : in.stones.sets) known.push_back(other);
  refuse_unknown(document, key, "set of stones", name, known);
}

void check_region(const Document& document, const CaseInput& in, const std::string& key,
                  const std::string& name) {
  if (in.regions.contains(name)) return;
  std::vector<std::string> known;
  for (const auto& [other, region] : in.regions) known.push_back(other);
  refuse_unknown(document, key, "region", name, known);
}

void check_measures(const Document& document, const Simulation& sim, const std::string& key,
                    const std::vector<std::string>& names) {
  for (const std::string& name : names)
    if (const auto hint = hint_for_measure(sim, name))
      document.fail(key, "there is no measure called " + name, *hint);
}

void check_names(const Document& document, const CaseInput& in) {
  std::string container;
  bool is_of_parts = false;
  for (const auto& [name, wall] : in.walls) {
    check_plain(document, "walls", name);
    if (!wall.input->is_container()) continue;
    const bool is_part = wall.input->is_part_of_container();
    if (!container.empty() && !(is_of_parts && is_part))
      document.fail(wall.input->here + ".kind", "there are two containers, but one at most",
                    fmt::format("{} is the container; make the other walls of planes or a mesh", container));
    container = name;
    is_of_parts = is_part;
  }
  for (const auto& [name, set] : in.stones.sets) check_plain(document, "stones.sets", name);
  for (const auto& [name, region] : in.regions) check_plain(document, "regions", name);
  for (const auto& [name, body] : in.bodies) {
    check_plain(document, "bodies", name);
    if (in.walls.contains(name))
      document.fail(body.input->here, fmt::format("{} is the name of a wall and of a body", name),
                    "give one of them another name");
  }
}

void check_stage_list(const Document& document, const std::vector<OneOf<StageInput>>& stages,
                      const CaseInput& in, const Simulation& sim) {
  std::map<std::string, std::string> seen;
  for (const OneOf<StageInput>& one : stages) {
    const StageInput& stage = *one.input;
    if (const auto [first, is_new] = seen.emplace(stage.name, stage.here); !is_new)
      document.fail(
          stage.here + ".name", fmt::format("two stages are called {}", stage.name),
          fmt::format("the other is {}; a stage without name is called by its kind: give each a name of its "
                      "own",
                      first->second));
    stage.check(document, in, sim);
  }
}

Presence::Presence(const Simulation& sim) : sim_(sim) {
  for (const WallState& wall : sim.state.walls) is_there_.push_back(wall.present);
}

void Presence::check(const Document& document, const std::string& key, const std::string& name) const {
  const std::size_t wall = index(name);
  if (is_there_[wall]) return;
  if (sim_.model.walls[wall].body)
    document.fail(key, fmt::format("{} is not in its place yet", name),
                  "place it before, with a stage of kind insert");
  document.fail(key, fmt::format("{} has been taken away", name), "let the stage that removes it come later");
}

void check_stages(const Document& document, const CaseInput& in, const Simulation& sim) {
  check_stage_list(document, in.stages, in, sim);
  Presence presence(sim);
  for (const OneOf<StageInput>& stage : in.stages) stage.input->follow(document, presence);
  std::vector<std::string> names;
  for (const OneOf<StageInput>& stage : in.stages) names.push_back(stage.input->name);
  std::ranges::sort(names);
  const auto check_names = [&](const char* key, const std::vector<std::string>& asked) {
    for (const std::string& name : asked)
      if (std::ranges::find(names, name) == names.end()) refuse_unknown(document, key, "stage", name, names);
  };
  check_names("record.stages", in.record.stages);
  check_names("record.keep", in.record.keep);
}

void check_in_plane(const Document& document, const Simulation& sim, const std::string& key,
                    const Vec3& vector) {
  if (sim.model.space.is_plane() && vector.y() != 0)
    document.fail(key, "it leads out of the plane y = 0 of a model with a thickness",
                  "give it no part along y, or leave out thickness");
}

void check_plane(const Document& document, const CaseInput& in, const Simulation& sim) {
  const Space& space = sim.model.space;
  if (!space.is_plane()) return;
  check_in_plane(document, sim, "numerics.gravity", sim.model.gravity);
  const auto reaches_through = [&](double low, double high) {
    return std::abs(high - 0.5 * space.thickness) < 1e-9 && std::abs(low + 0.5 * space.thickness) < 1e-9;
  };
  if (!sim.container.isEmpty() && !reaches_through(sim.container.min().y(), sim.container.max().y()))
    document.fail(
        "thickness",
        fmt::format("the container goes from {:g} to {:g} m along y, not through a thickness of {:g} m",
                    sim.container.min().y(), sim.container.max().y(), space.thickness),
        "give the container that width, with its middle at y = 0");
  for (const auto& [name, body] : in.bodies) {
    const Wall& wall = sim.model.walls[static_cast<std::size_t>(sim.find_wall(name))];
    Eigen::AlignedBox3d box;
    for (const Vec3& v : wall.shape.mesh.vertices)
      box.extend(sim.state.walls[static_cast<std::size_t>(sim.find_wall(name))].pose.orientation * v);
    if (!reaches_through(box.min().y(), box.max().y()))
      document.fail(body.input->here,
                    fmt::format("{} is {:g} m wide along y, the thickness is {:g} m", name, box.sizes().y(),
                                space.thickness),
                    "give it the width of the thickness: its mass is that of the whole width");
  }
  for (std::size_t w = 0; w < sim.model.walls.size(); ++w) {
    if (!sim.model.walls[w].shape.is_plane) continue;
    const std::string& name = sim.model.walls[w].shape.name;
    if (std::abs((sim.state.walls[w].pose.orientation * Vec3::UnitZ()).y()) > 1e-12)
      document.fail("walls." + name.substr(0, name.find('.')), "this plane does not stand on the plane y = 0",
                    "give its normal no part along y");
  }
}

void check_time_step(const Document& document, const CaseInput& in, const Simulation& sim) {
  if (!in.numerics.time_step) return;
  // A stone of the smallest size, of each shape, alone: what a stone allows that may touch anything.
  Model model = sim.model;
  model.walls.clear();
  model.limits = {};
  model.domain.setEmpty();  // where it stands does not matter
  model.time_step.fixed.reset();
  const GradingInput& grading = in.stones.grading;
  double stable = std::numeric_limits<double>::infinity();
  for (const StoneSet& set : sim.stone_sets)
    for (int shape = set.first; shape < set.first + set.count; ++shape) {
      State state;
      Workspace work;
      const ClumpTemplate& t = model.templates[static_cast<std::size_t>(shape)];
      add_clump(model, state, shape, scale_to_size(grading, model.space, t, smallest_size(grading)),
                set.material, {});
      settle_contacts(model, state, work);
      stable = std::min(stable, state.planned_dt);
    }
  if (*in.numerics.time_step > stable)
    document.fail("numerics.time_step",
                  fmt::format("time_step is above the stable one, {:.3g} s for the smallest stones", stable),
                  "give a smaller one, or leave it out: Trackbed then finds the largest stable one");
}

}  // namespace trackbed
