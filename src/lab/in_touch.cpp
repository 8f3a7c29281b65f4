#include "lab/in_touch.h"

#include "dem/touching.h"

namespace trackbed {

using Index = std::size_t;

std::vector<BodyPair> pairs_in_touch(const Simulation& sim) {
  std::vector<BodyPair> pairs;
  // The contacts of one pair follow each other.
  visit_touching(sim.model, sim.state, [&](const Touching& t) {
    const bool same = !pairs.empty() && pairs.back().clump_1 == t.clump_1 &&
                      pairs.back().clump_2 == t.clump_2 && pairs.back().wall == t.wall;
    if (!same) pairs.push_back({t.clump_1, t.clump_2, t.wall, 0, Vec3::Zero(), Vec3::Zero()});
    BodyPair& pair = pairs.back();
    ++pair.contacts;
    pair.force += t.force();
    pair.point += t.point;
  });
  for (BodyPair& pair : pairs) pair.point /= pair.contacts;
  return pairs;
}

std::vector<StoneContacts> contacts_of_stones(const Simulation& sim) {
  std::vector<StoneContacts> stones(static_cast<Index>(sim.state.clumps.size()));
  for (const BodyPair& pair : pairs_in_touch(sim)) {
    for (int c : {pair.clump_1, pair.clump_2}) {
      if (c < 0) continue;
      ++stones[static_cast<Index>(c)].neighbours;
      stones[static_cast<Index>(c)].contacts += pair.contacts;
    }
  }
  visit_touching(sim.model, sim.state, [&](const Touching& t) {
    // The force on body 2 points away from the centre of body 1 and towards that of body 2.
    const Vec3 force = t.force();
    stones[static_cast<Index>(t.clump_1)].mean_stress += force.dot(t.lever_1);
    if (t.clump_2 >= 0) stones[static_cast<Index>(t.clump_2)].mean_stress -= force.dot(t.lever_2);
  });
  for (Index c = 0; c < stones.size(); ++c)
    stones[c].mean_stress /= sim.model.space.dimensions() * volume_of(sim, c);
  return stones;
}

double volume_of(const Simulation& sim, std::size_t clump) {
  return trackbed::volume_of(sim.model, sim.state.clumps, clump);
}

double equal_volume_radius(const Simulation& sim, std::size_t clump) {
  return trackbed::equal_volume_radius(sim.model, sim.state.clumps, clump);
}

}  // namespace trackbed
