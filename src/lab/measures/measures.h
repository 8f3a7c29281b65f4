// The functions behind the table of measures, by what they look at.
#pragma once

#include "lab/measure.h"

namespace trackbed {

/// Contacts and pairs of bodies in touch.
struct ContactCounts {
  int stone = 0, wall = 0;              // contacts of pebbles, between stones and with walls or bodies
  int stone_pairs = 0, wall_pairs = 0;  // bodies in touch
  ContactCounts& operator+=(const ContactCounts& other);
};
ContactCounts contact_counts(const Simulation& sim);

int pebbles(const Simulation& sim);

/// Share of a sum over the stones; 0 when there is none.
double per_stone(const Simulation& sim, double sum);

/// Stones that touch fewer than two other bodies: nothing is passed on through them.
int rattlers(const Simulation& sim);

double largest_displacement(const Simulation& sim);   ///< of a stone since the stage began [m]
double mean_contact_force(const Simulation& sim);     ///< magnitude, elastic [N]
double largest_contact_force(const Simulation& sim);  ///< [N]
double largest_overlap(const Simulation& sim);        ///< over the smaller stone's equal-volume radius [-]

double pebble_volume(const Simulation& sim);  ///< of the unions of each stone's pebbles [m^3]
double solid_volume(const Simulation& sim);   ///< of the stones, overlaps counted twice [m^3]
double weight(const Simulation& sim);         ///< of stones and bodies [N]
/// Share of the stones' weight that contacts bear in sum; 0 without stones or gravity.
double weight_borne(const Simulation& sim);
double median_size(
    const Simulation& sim);  ///< half of the mass is of stones with a smaller equal-volume diameter

double bed_height(const Simulation& sim);  ///< bed_surface over the whole container [m]
/// Of the container up to the bed's surface, which follows slopes, bodies below it left out [m^3].
double bed_volume(const Simulation& sim);
/// Share of pores in the container up to the bed's surface, bodies below it left out; 1 without stones.
double porosity(const Simulation& sim, double solid);  ///< with this volume of solids [m^3]
/// Mean stress of the bed, from its contacts (Love 1927; docs/theory.md), compression positive.
struct BedStress {
  double mean = 0;  // a third of the trace of sum(force x branch) / volume [Pa]
  double stiffness =
      0;              // sum of k_n branch_n^2: how much 3 volume x mean grows with the stones' lengths [N m]
  double volume = 0;  // bed_volume [m^3]
};
BedStress bed_stress(const Simulation& sim);

/// Part of a body below height z [m^3]; its mesh must be closed.
double volume_below(const WallShape& shape, const Pose& pose, double z);

/// Forces, moments and motion of one wall or body.
std::vector<Measure> wall_measures(const Wall& wall, std::size_t index);

}  // namespace trackbed
