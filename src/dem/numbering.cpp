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
    return std::tuple(row(axis[0]), row(axis[1]), from[axis[2]]);
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
  for (auto* numbers : {&c.scale, &c.mass}) reorder(*numbers, order);
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
  state.pair_blocks.assign(contacts.empty() ? 0 : 1, {});
  for (const Loose& c : contacts) {
    PairBlock& block = state.pair_blocks.front();
    if (block.pairs.empty() || block.pairs.back().i != c.i || block.pairs.back().j != c.j)
      block.pairs.push_back({c.i, c.j, static_cast<int>(block.keys.size()), 0});
    ++block.pairs.back().count;
    block.keys.push_back(c.key);
    block.memory.push_back(c.memory);
  }
}

void renumber_wall_contacts(State& state, const std::vector<int>& number) {
  struct LooseAtWall {
    int wall, clump, key;
    const WallMemory* memory;
  };
  std::vector<LooseAtWall> contacts;
  const std::vector<WallBlock> old = std::move(state.wall_blocks);
  for (const WallBlock& block : old)
    for (const WallPair& p : block.pairs)
      for (Index k = static_cast<Index>(p.first); k < static_cast<Index>(p.first + p.count); ++k)
        contacts.push_back({p.wall, number[static_cast<Index>(p.clump)], block.keys[k], &block.memory[k]});
  std::sort(contacts.begin(), contacts.end(), [](const LooseAtWall& a, const LooseAtWall& b) {
    return std::tie(a.wall, a.clump, a.key) < std::tie(b.wall, b.clump, b.key);
  });
  state.wall_blocks.assign(contacts.empty() ? 0 : 1, {});
  for (const LooseAtWall& c : contacts) {
    WallBlock& block = state.wall_blocks.front();
    if (block.pairs.empty() || block.pairs.back().wall != c.wall || block.pairs.back().clump != c.clump)
      block.pairs.push_back({c.clump, c.wall, static_cast<int>(block.keys.size()), 0});
    ++block.pairs.back().count;
    block.keys.push_back(c.key);
    block.memory.push_back(*c.memory);
  }
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
