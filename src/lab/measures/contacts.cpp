#include <algorithm>

#include "dem/touching.h"
#include "lab/in_touch.h"
#include "lab/measures/measures.h"

namespace trackbed {

using Index = std::size_t;

namespace {

int touching_points(const ContactMemory& memory) {
  return memory.touches();
}
int touching_points(const WallMemory& memory) {
  return static_cast<int>(std::ranges::count_if(memory.points, &ContactMemory::touches));
}

/// Adds those of all blocks, of which nothing but the touch needs to be known.
template <class Block>
void count(const std::vector<Block>& blocks, int ContactCounts::*contacts, int ContactCounts::*pairs,
           ContactCounts& counts) {
  const auto add_block = [&](ContactCounts& sum, Index b) {
    for (const auto& pair : blocks[b].pairs) {
      int points = 0;
      for (int k = pair.first; k < pair.first + pair.count; ++k)
        points += touching_points(blocks[b].memory[static_cast<Index>(k)]);
      sum.*contacts += points;
      sum.*pairs += points > 0 ? 1 : 0;
    }
  };
  counts += sum_by_runs<ContactCounts>(blocks.size(), add_block, blocks_in_run);
}

/// Of numbers, with how many they are.
struct Sum {
  double value = 0;
  int n = 0;
  Sum& operator+=(const Sum& other) {
    value += other.value;
    n += other.n;
    return *this;
  }
};

/// A "sum" that is its largest member.
struct Largest {
  double value = 0;
  Largest& operator+=(const Largest& other) {
    value = std::max(value, other.value);
    return *this;
  }
};

}  // namespace

ContactCounts& ContactCounts::operator+=(const ContactCounts& other) {
  stone += other.stone;
  wall += other.wall;
  stone_pairs += other.stone_pairs;
  wall_pairs += other.wall_pairs;
  return *this;
}

ContactCounts contact_counts(const Simulation& sim) {
  ContactCounts counts;
  count(sim.state.pair_blocks, &ContactCounts::stone, &ContactCounts::stone_pairs, counts);
  count(sim.state.wall_blocks, &ContactCounts::wall, &ContactCounts::wall_pairs, counts);
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
  const Sum sum = sum_of_touching<Sum>(sim.model, sim.state, [](Sum& all, const Touching& t) {
    all += {t.force().norm(), 1};
  });
  return sum.n > 0 ? sum.value / sum.n : 0.0;
}

double largest_contact_force(const Simulation& sim) {
  return sum_of_touching<Largest>(sim.model, sim.state,
                                  [](Largest& all, const Touching& t) { all += {t.force().norm()}; })
      .value;
}

double largest_overlap(const Simulation& sim) {
  const std::vector<double> radii = equal_volume_radii(sim.model, sim.state.clumps);
  const auto add = [&](Largest& all, const Touching& t) {
    all += {t.overlap / smaller_of_stones(t, [&](Index i) { return radii[i]; })};
  };
  return sum_of_touching<Largest>(sim.model, sim.state, add).value;
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
