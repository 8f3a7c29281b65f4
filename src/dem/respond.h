// The response of several contacts at a time, whatever their geometry comes from.
#pragma once

#include <array>

#include "base/lanes.h"
#include "dem/contact.h"
#include "dem/material.h"

namespace trackbed {

/// The rows that get(0), get(1), ... give, turned into lanes.
template <class Get>
Vec3Of<Lanes> gather(const Get& get, Lanes& fourth) {
  Rows rows;
  for (std::size_t k = 0; k < rows.size(); ++k) rows[k] = get(k);
  const Columns c = columns_of(rows);
  fourth = c[3];
  return {c[0], c[1], c[2]};
}

/// Visits the lanes of `wanted` by runs of those that have the same key, in ascending order; almost always
/// all in one run. So sums come in the order of the lanes, whatever lies between them.
template <class KeyOf, class Visit>
void by_runs(unsigned wanted, const KeyOf& key_of, const Visit& visit) {
  while (wanted != 0) {
    const auto key = key_of(static_cast<std::size_t>(__builtin_ctz(wanted)));
    unsigned run = 0;
    for (unsigned left = wanted; left != 0; left &= left - 1) {
      if (key_of(static_cast<std::size_t>(__builtin_ctz(left))) != key) break;
      run |= left & -left;
    }
    visit(key, run);
    wanted &= ~run;
  }
}

/// The lanes that hold something when `left` are left.
inline unsigned lanes_of(std::size_t left) {
  return left < Lanes::size ? (1u << left) - 1u : (1u << Lanes::size) - 1u;
}

struct Response {
  Vec3Of<Lanes> force;   // on body 2 [N]
  Vec3Of<Lanes> moment;  // on body 2 about the point from which the lever is measured [N m]
  LossesOf<Lanes> losses;
};

/// Lets a law answer the motion of contacts; `lever` leads from the centre of mass of body 1 to the
/// contact. The memories in the lanes of `wanted` are brought up to date; what is worked out in the other
/// lanes means nothing.
template <class Law>
Response respond_with(const ContactKinematicsOf<Lanes>& k, const ContactProperties& p,
                      const Vec3Of<Lanes>& lever, const std::array<ContactMemory*, Lanes::size>& memories,
                      unsigned wanted) {
  const auto load = [&](auto member) {
    Rows rows;
    for (std::size_t n = 0; n < rows.size(); ++n) rows[n] = Row::load((memories[n]->*member).data());
    return columns_of(rows);
  };
  const auto store = [&](auto member, const Vec3Of<Lanes>& v, Lanes fourth) {
    const Rows rows = rows_of({v.x(), v.y(), v.z(), fourth});
    for (std::size_t n = 0; n < rows.size(); ++n)
      if (wanted >> n & 1u) rows[n].store((memories[n]->*member).data());
  };
  ContactMemoryOf<Lanes> memory;
  const auto normal = load(&ContactMemory::normal), shear = load(&ContactMemory::shear);
  memory.normal = {normal[0], normal[1], normal[2]};
  memory.overlap = normal[3];
  memory.shear = {shear[0], shear[1], shear[2]};
  if constexpr (Law::rolls) {
    const auto rolling = load(&ContactMemory::rolling);
    memory.rolling = {rolling[0], rolling[1], rolling[2]};
  }

  Response out;
  const ContactForceOf<Lanes> response = Law::respond(k, p, memory, out.losses);
  store(&ContactMemory::normal, memory.normal, memory.overlap);
  store(&ContactMemory::shear, memory.shear, 0.0);
  if constexpr (Law::rolls) store(&ContactMemory::rolling, memory.rolling, 0.0);
  out.force = response.force;
  out.moment = lever.cross(response.force);
  if constexpr (Law::rolls) out.moment += response.moment;
  return out;
}

}  // namespace trackbed
