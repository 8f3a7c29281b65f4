#include <algorithm>

#include "dem/touching.h"
#include "lab/in_touch.h"
#include "lab/measures/measures.h"

namespace trackbed {

using Index = std::size_t;

ContactCounts contact_counts(const Simulation& sim) {
  ContactCounts counts;
  for (const BodyPair& pair : pairs_in_touch(sim)) {
    const bool with_wall = pair.wall >= 0;
    (with_wall ? counts.wall : counts.stone) += pair.contacts;
    ++(with_wall ? counts.wall_pairs : counts.stone_pairs);
  }
  return counts;
}

int pebbles(const Simulation& sim) {
  std::size_t sum = 0;
  for (int shape : sim.state.clumps.shape)
    sum += sim.model.templates[static_cast<Index>(shape)].pebbles.size();
  return static_cast<int>(sum);
}

double per_stone(const Simulation& sim, double sum) {
  const int n = sim.state.clumps.size();
  return n > 0 ? sum / n : 0.0;
}

int rattlers(const Simulation& sim) {
  const std::vector<StoneContacts> stones = contacts_of_stones(sim);
  return static_cast<int>(
      std::ranges::count_if(stones, [](const StoneContacts& s) { return s.neighbours < 2; }));
}

double mean_contact_force(const Simulation& sim) {
  double sum = 0;
  int n = 0;
  visit_touching(sim.model, sim.state, [&](const Touching& t) {
    sum += t.force().norm();
    ++n;
  });
  return n > 0 ? sum / n : 0.0;
}

double largest_contact_force(const Simulation& sim) {
  double largest = 0;
  visit_touching(sim.model, sim.state,
                 [&](const Touching& t) { largest = std::max(largest, t.force().norm()); });
  return largest;
}

double largest_overlap(const Simulation& sim) {
  double largest = 0;
  const std::vector<double> radii = equal_volume_radii(sim.model, sim.state.clumps);
  visit_touching(sim.model, sim.state, [&](const Touching& t) {
    largest = std::max(largest, t.overlap / smaller_of_stones(t, [&](Index i) { return radii[i]; }));
  });
  return largest;
}

std::vector<int> force_histogram(const Simulation& sim, const std::vector<double>& limits) {
  std::vector<int> counts(limits.size() + 1, 0);
  visit_touching(sim.model, sim.state, [&](const Touching& t) {
    const auto above = std::ranges::upper_bound(limits, t.force().norm());
    ++counts[static_cast<Index>(above - limits.begin())];
  });
  return counts;
}

}  // namespace trackbed
