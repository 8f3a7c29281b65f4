// Who touches whom: bodies in touch are counted once, however many of their pebbles meet.
#pragma once

#include <vector>

#include "lab/simulation.h"

namespace trackbed {

/// Two bodies in touch. Body 1 is a stone; body 2 a stone or a wall, the other index is -1.
struct BodyPair {
  int clump_1, clump_2, wall;
  int contacts;  // of their pebbles
  Vec3 force;    // elastic, on body 2, sum of its contacts [N]
  Vec3 point;    // mean of the contact points [m]
};

/// Stone pairs first, then stones with walls, in the order of their indices.
std::vector<BodyPair> pairs_in_touch(const Simulation& sim);

/// What touches one stone.
struct StoneContacts {
  int neighbours = 0;  // stones, walls and bodies
  int contacts = 0;    // of its pebbles
  double mean_stress =
      0;  // trace of sum(force x lever) / volume over the dimensions, compression positive [Pa]
};

/// One entry a stone.
std::vector<StoneContacts> contacts_of_stones(const Simulation& sim);

double volume_of(const Simulation& sim, std::size_t clump);  ///< of a stone [m^3]
double equal_volume_radius(const Simulation& sim,
                           std::size_t clump);  ///< of the ball or disc of that volume [m]

}  // namespace trackbed
