#include "dem/numbering.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <tuple>
#include <vector>

namespace trackbed {
namespace {

using Index = std::size_t;

/// So few that a layer of a strip stays in the cache until its neighbour layer has been worked on.
constexpr double rows_of_strip = 16;

/// Indices of the stones in their new order.
std::vector<Index> order_by_place(const std::vector<Vec3>& position) {
  Eigen::AlignedBox3d box;
  for (const Vec3& x : position) box.extend(x);
  std::array<int, 3> axis{0, 1, 2};
  std::stable_sort(axis.begin(), axis.end(), [&](int a, int b) { return box.sizes()[a] > box.sizes()[b]; });
  // Layers and rows about one stone thick, if the bed fills its box.
  const double cell = std::cbrt(box.volume() / static_cast<double>(position.size()));
  const auto place = [&](const Vec3& x) {
    const Vec3 from = x - box.min();
    const auto row = [&](int a) { return cell > 0 ? std::floor(from[a] / cell) : 0.0; };
    return std::tuple(std::floor(row(axis[1]) / rows_of_strip), row(axis[0]), row(axis[1]), from[axis[2]]);
  };
  std::vector<Index> order(position.size());
  std::iota(order.begin(), order.end(), Index{0});
  std::stable_sort(order.begin(), order.end(),
                   [&](Index a, Index b) { return place(position[a]) < place(position[b]); });
  return order;
}

template <class T>
void reorder(std::vector<T>& values, const std::vector<Index>& order) {
  std::vector<T> sorted;
  sorted.reserve(values.size());
  for (Index k : order) sorted.push_back(values[k]);
  values = std::move(sorted);
}

void reorder(Clumps& c, const std::vector<Index>& order) {
  for (auto* numbers : {&c.id, &c.shape, &c.material}) reorder(*numbers, order);
  for (auto* numbers : {&c.scale, &c.mass, &c.inertial_mass}) reorder(*numbers, order);
  for (auto* vectors :
       {&c.inertia, &c.position, &c.velocity, &c.angular_momentum, &c.angular_velocity, &c.force, &c.moment})
    reorder(*vectors, order);
  reorder(c.orientation, order);
  reorder(c.losses, order);
}

/// Seen from the other body.
void swap_bodies(ContactMemory& m) {
  m.normal = -m.normal;
  m.shear = -m.shear;
  m.rolling = -m.rolling;
}

bool same_bodies(const ClumpPair& a, const ClumpPair& b) {
  return a.i == b.i && a.j == b.j;
}
bool same_bodies(const WallPair& a, const WallPair& b) {
  return a.clump == b.clump && a.wall == b.wall;
}

/// One block with the contacts in the order given, those of one pair in a row. `pair_of` tells a contact's
/// pair; a Contact has a key and a memory.
template <class Block, class Contact, class PairOf>
std::vector<Block> one_block(const std::vector<Contact>& contacts, const PairOf& pair_of) {
  std::vector<Block> blocks(contacts.empty() ? 0 : 1);
  for (const Contact& c : contacts) {
    Block& block = blocks.front();
    auto pair = pair_of(c);
    pair.first = static_cast<int>(block.keys.size());
    if (block.pairs.empty() || !same_bodies(block.pairs.back(), pair)) block.pairs.push_back(pair);
    ++block.pairs.back().count;
    block.keys.push_back(c.key);
    block.memory.push_back(c.memory);
  }
  return blocks;
}

/// One contact between stones, out of its block.
struct Loose {
  int i, j;
  PebblePair key;
  ContactMemory memory;
};

void renumber_contacts(State& state, const std::vector<int>& number) {
  std::vector<Loose> contacts;
  for (const PairBlock& block : state.pair_blocks)
    for (const ClumpPair& p : block.pairs)
      for (Index k = static_cast<Index>(p.first); k < static_cast<Index>(p.first + p.count); ++k) {
        if (!block.memory[k].touches()) continue;
        Loose c{number[static_cast<Index>(p.i)], number[static_cast<Index>(p.j)], block.keys[k],
                block.memory[k]};
        if (c.i > c.j) {
          std::swap(c.i, c.j);
          std::swap(c.key.a, c.key.b);
          swap_bodies(c.memory);
        }
        contacts.push_back(c);
      }
  std::sort(contacts.begin(), contacts.end(), [](const Loose& a, const Loose& b) {
    return std::tie(a.i, a.j, a.key.a, a.key.b) < std::tie(b.i, b.j, b.key.a, b.key.b);
  });
  state.pair_blocks = one_block<PairBlock>(contacts, [](const Loose& c) {
    return ClumpPair{c.i, c.j, 0, 0};
  });
}

/// One contact with a wall, out of its block.
struct LooseAtWall {
  int wall, clump, key;
  WallMemory memory;
};

void renumber_wall_contacts(State& state, const std::vector<int>& number) {
  std::vector<LooseAtWall> contacts;
  for (const WallBlock& block : state.wall_blocks)
    for (const WallPair& p : block.pairs)
      for (Index k = static_cast<Index>(p.first); k < static_cast<Index>(p.first + p.count); ++k)
        contacts.push_back({p.wall, number[static_cast<Index>(p.clump)], block.keys[k], block.memory[k]});
  std::sort(contacts.begin(), contacts.end(), [](const LooseAtWall& a, const LooseAtWall& b) {
    return std::tie(a.wall, a.clump, a.key) < std::tie(b.wall, b.clump, b.key);
  });
  state.wall_blocks = one_block<WallBlock>(contacts, [](const LooseAtWall& c) {
    return WallPair{c.clump, c.wall, 0, 0};
  });
}

}  // namespace

void number_by_place(State& state) {
  if (state.clumps.size() == 0) return;
  const std::vector<Index> order = order_by_place(state.clumps.position);
  std::vector<int> number(order.size());
  for (Index k = 0; k < order.size(); ++k) number[order[k]] = static_cast<int>(k);
  reorder(state.clumps, order);
  renumber_contacts(state, number);
  renumber_wall_contacts(state, number);
}

}  // namespace trackbed
