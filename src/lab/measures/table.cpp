// The table of measures: one row each.
#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <utility>

#include "base/error.h"
#include "io/nearest.h"
#include "lab/measures/measures.h"

namespace trackbed {
namespace {

using Sim = const Simulation&;

std::vector<Measure> stone_measures() {
  using enum Dimension;
  return {
      {"stones", none, "number of stones", [](Sim s) { return s.state.clumps.size(); }},
      {"pebbles", none, "of all stones", pebbles},
      {"solid_volume", volume, "of all stones, overlaps counted twice", solid_volume},
      {"weight", force, "of stones and bodies", weight},
      {"weight_borne", none,
       "share of the stones' weight that walls and bodies bear: below 1 while some fall, or hover with a "
       "scaled step",
       weight_borne},
      {"stone_displacement_max", length, "of the stone that has moved most since the stage began",
       largest_displacement},
      {"d50", length, "equal-volume diameter that half of the mass is below", median_size},
  };
}

/// A measure that `value(counts)` makes of the numbers of contacts, which are counted once for it.
template <class Value>
Measure of_counts(std::string name, std::string meaning, Value value) {
  return {std::move(name), Dimension::none, std::move(meaning),
          [value](Sim s) { return value(contact_counts(s)); }};
}

template <class Value>
Measure of_counts_per_stone(std::string name, std::string meaning, Value value) {
  return {std::move(name), Dimension::none, std::move(meaning),
          [value](Sim s) { return per_stone(s, value(contact_counts(s))); }};
}

std::vector<Measure> contact_measures() {
  using enum Dimension;
  using Counts = const ContactCounts&;
  return {
      of_counts("contacts", "touching pebbles: of two stones, and of a stone with a wall or body",
                [](Counts c) { return c.stone + c.wall; }),
      of_counts("contacts_stone", "touching pebbles of two stones", [](Counts c) { return c.stone; }),
      of_counts("contacts_wall", "touches of pebbles with walls and bodies", [](Counts c) { return c.wall; }),
      of_counts("pairs", "bodies in touch, each pair once however many pebbles touch",
                [](Counts c) { return c.stone_pairs + c.wall_pairs; }),
      of_counts_per_stone("coordination_number", "contacts / stones, each contact counted once",
                          [](Counts c) { return c.stone + c.wall; }),
      of_counts_per_stone("coordination_number_stones", "contacts_stone / stones, each contact counted once",
                          [](Counts c) { return c.stone; }),
      of_counts_per_stone("contacts_per_stone",
                          "mean number of contacts a stone has: (2 contacts_stone + contacts_wall) / stones",
                          [](Counts c) { return 2 * c.stone + c.wall; }),
      of_counts_per_stone("neighbours_per_stone", "mean number of bodies that a stone touches",
                          [](Counts c) { return 2 * c.stone_pairs + c.wall_pairs; }),
      {"rattlers", none, "stones that touch fewer than two other bodies", rattlers},
      {"contact_force_mean", force, "magnitude of the elastic contact force, mean of all contacts",
       mean_contact_force},
      {"contact_force_max", force, "magnitude of the largest elastic contact force", largest_contact_force},
      {"largest_overlap", none, "overlap / equal-volume radius of the smaller stone", largest_overlap},
      {"unbalanced_ratio", none,
       "sum of unbalanced forces / sum of all forces; below 1e-3 the bed is at rest",
       [](Sim s) { return unbalanced_ratio(s.model, s.state); }},
  };
}

/// Contacts in each range between the limits of the case.
std::vector<Measure> range_measures(Sim sim) {
  std::vector<Measure> all;
  const std::vector<double>& limits = sim.force_limits;
  for (std::size_t k = 0; k < limits.size() + (limits.empty() ? 0 : 1); ++k) {
    std::string name = "contacts_below", range = "below";
    if (k == limits.size()) name = "contacts_above", range = "of or above";
    if (k > 0 && k < limits.size()) {
      name = fmt::format("contacts_{:g}", limits[k - 1]);
      range = fmt::format("from {:g} N to below", limits[k - 1]);
    }
    const double limit = limits[std::min(k, limits.size() - 1)];
    all.push_back({fmt::format("{}_{:g}_N", name, limit), Dimension::none,
                   fmt::format("contacts whose elastic force is {} {:g} N (record.force_bins)", range, limit),
                   [k](Sim s) { return force_histogram(s, s.force_limits)[k]; }});
  }
  return all;
}

Measure energy(std::string name, std::string meaning, double EnergyBalance::*part) {
  return {std::move(name), Dimension::energy, std::move(meaning),
          [part](Sim s) { return energy_of(s.model, s.state).*part; }};
}

std::vector<Measure> energy_measures() {
  return {
      energy("energy_kinetic", "of stones and bodies", &EnergyBalance::kinetic),
      energy("energy_potential", "of stones and bodies above z = 0", &EnergyBalance::potential),
      energy("energy_strain", "in the springs of contacts", &EnergyBalance::strain),
      energy("loss_friction", "heat of sliding since the start", &EnergyBalance::friction_loss),
      energy("loss_rolling", "heat of rolling since the start", &EnergyBalance::rolling_loss),
      energy("loss_dashpot", "heat of dashpots since the start", &EnergyBalance::dashpot_loss),
      energy("loss_damping", "heat of local damping since the start", &EnergyBalance::damping_loss),
      energy("boundary_work", "of moved walls on the stones since the start", &EnergyBalance::boundary_work),
      energy("applied_work", "of applied forces on bodies since the start", &EnergyBalance::applied_work),
      {"energy_total", Dimension::energy,
       "energies and losses less the works: constant while stones are the same",
       [](Sim s) { return energy_of(s.model, s.state).total(); }},
  };
}

std::vector<Measure> bed_measures() {
  using enum Dimension;
  return {
      {"bed_height", length, "of the bed's surface above z = 0, beside bodies", bed_height},
      {"porosity", none,
       "share of pores in the container below the bed's surface, bodies left out; stones by their meshes",
       [](const Simulation& sim) { return porosity(sim, solid_volume(sim)); }},
      {"porosity_of_pebbles", none, "the same with stones by their pebbles, which fill less than the mesh",
       [](const Simulation& sim) { return porosity(sim, pebble_volume(sim)); }},
  };
}

}  // namespace

std::vector<Measure> measures_of(const Simulation& sim) {
  std::vector<Measure> all;
  const auto add = [&](std::vector<Measure> more) { std::ranges::move(more, std::back_inserter(all)); };
  add(stone_measures());
  add(contact_measures());
  add(range_measures(sim));
  if (!sim.container.isEmpty()) add(bed_measures());
  add(energy_measures());
  for (std::size_t w = 0; w < sim.model.walls.size(); ++w) add(wall_measures(sim.model.walls[w], w));
  return all;
}

void add_body_by_name(Simulation& sim, const std::string& name) {
  add_wall(sim, {make_plane_wall(name, 1.0), 0, BodyProperties{}}, {});
}

std::optional<std::string> hint_for_measure(const Simulation& sim, const std::string& name) {
  std::vector<std::string> known;
  for (const Measure& m : measures_of(sim)) known.push_back(m.name);
  if (std::ranges::find(known, name) != known.end()) return std::nullopt;
  return known_words(name, known, few_words) + "; trackbed describe measures lists all";
}

std::vector<Measure> measures_called(const Simulation& sim, const std::vector<std::string>& names) {
  if (names.empty()) return {};
  const std::vector<Measure> all = measures_of(sim);
  std::vector<Measure> chosen;
  for (const std::string& name : names) {
    const auto found = std::ranges::find(all, name, &Measure::name);
    if (found == all.end())
      throw InputError(
          fmt::format("there is no measure called {}\n  hint: {}", name, *hint_for_measure(sim, name)));
    chosen.push_back(*found);
  }
  return chosen;
}

}  // namespace trackbed
