#include "dem/state.h"

#include <algorithm>
#include <cmath>

#include "base/hash.h"
#include "base/runs.h"
#include "dem/rotation.h"

namespace trackbed {
namespace {

using Index = std::size_t;

template <class T>
void erase_at(std::vector<T>& values, const std::vector<bool>& gone) {
  Index kept = 0;
  for (Index k = 0; k < values.size(); ++k)
    if (!gone[k]) values[kept++] = values[k];
  values.resize(kept);
}

template <class Matrix>
void add(Hash& hash, const Matrix& m) {
  for (Eigen::Index k = 0; k < m.size(); ++k) hash.add(m.data()[k]);
}

void add(Hash& hash, const ContactMemory& m) {
  hash.add(m.overlap);
  add(hash, m.normal);
  add(hash, m.shear);
  add(hash, m.rolling);
}

/// Mass and inertia as shape, size and material have it; the speeds stay, and the share by which inertia is
/// scaled.
void weigh(const Model& model, State& state, int clump) {
  const Index i = static_cast<Index>(clump);
  Clumps& c = state.clumps;
  const ClumpTemplate& t = model.templates[static_cast<Index>(c.shape[i])];
  const double density = model.materials[static_cast<Index>(c.material[i])].density, scale = c.scale[i];
  const double scaled = c.mass[i] > 0 ? c.inertial_mass[i] / c.mass[i] : 1.0;
  c.mass[i] = density * volume_of(model, c, i);
  c.inertial_mass[i] = scaled * c.mass[i];
  c.inertia[i] = scaled * density * scale * scale * model.space.growth_of_volume(scale) * t.inertia;
  set_motion(state, clump, c.velocity[i], c.angular_velocity[i]);
}

}  // namespace

double volume_of(const Model& model, const Clumps& clumps, std::size_t clump) {
  return model.templates[static_cast<Index>(clumps.shape[clump])].volume *
         model.space.growth_of_volume(clumps.scale[clump]);
}

double equal_volume_radius(const Model& model, const Clumps& clumps, std::size_t clump) {
  return 0.5 * model.space.size_of_volume(volume_of(model, clumps, clump));
}

std::vector<double> equal_volume_radii(const Model& model, const Clumps& clumps) {
  std::vector<double> radii(clumps.id.size());
  for_each_by_runs(radii.size(), [&](Index k) { radii[k] = equal_volume_radius(model, clumps, k); });
  return radii;
}

int add_clump(const Model& model, State& state, int shape, double scale, int material, const Pose& pose) {
  Clumps& c = state.clumps;
  c.id.push_back(c.next_id++);
  c.shape.push_back(shape);
  c.material.push_back(material);
  c.scale.push_back(scale);
  for (auto* zero : {&c.mass, &c.inertial_mass}) zero->push_back(0.0);
  c.position.push_back(pose.position);
  c.orientation.push_back(pose.orientation);
  for (auto* zero : {&c.inertia, &c.velocity, &c.angular_momentum, &c.angular_velocity, &c.force, &c.moment})
    zero->push_back(Vec3::Zero());
  c.losses.emplace_back();
  weigh(model, state, c.size() - 1);
  return c.size() - 1;
}

void set_motion(State& state, int clump, const Vec3& velocity, const Vec3& angular_velocity) {
  const Index i = static_cast<Index>(clump);
  Clumps& c = state.clumps;
  const Mat3 r = c.orientation[i].toRotationMatrix();
  c.velocity[i] = velocity;
  c.angular_velocity[i] = angular_velocity;
  c.angular_momentum[i] = r * (r.transpose() * angular_velocity).cwiseProduct(c.inertia[i]);
}

namespace {

/// Lets go of the candidates of the pairs that `is_gone` tells, and of the pairs.
template <class Block, class IsGone>
void forget_pairs(std::vector<Block>& blocks, const IsGone& is_gone) {
  for (Block& block : blocks) std::erase_if(block.pairs, is_gone);
}

}  // namespace

void rescale(const Model& model, State& state, int clump, double factor) {
  state.clumps.scale[static_cast<Index>(clump)] *= factor;
  weigh(model, state, clump);
}

void scale_inertia(State& state, int clump, double factor) {
  const Index i = static_cast<Index>(clump);
  Clumps& c = state.clumps;
  const auto kinetic = [&] {
    return 0.5 * (c.inertial_mass[i] * c.velocity[i].squaredNorm() +
                  c.angular_velocity[i].dot(c.angular_momentum[i]));
  };
  const double before = kinetic(), slower = std::min(1.0, 1.0 / factor);
  c.inertial_mass[i] *= factor;
  c.inertia[i] *= factor;
  set_motion(state, clump, slower * c.velocity[i], slower * c.angular_velocity[i]);
  c.losses[i].damping += before - kinetic();
}

void unscale_inertia(const Model& model, State& state, int clump) {
  const Index i = static_cast<Index>(clump);
  scale_inertia(state, clump, state.clumps.mass[i] / state.clumps.inertial_mass[i]);
  state.clumps.inertial_mass[i] = state.clumps.mass[i];
  weigh(model, state, clump);
}

void reshape(const Model& model, State& state, const std::vector<Reshaped>& stones) {
  std::vector<bool> is_new(state.clumps.id.size(), false);
  for (const Reshaped& r : stones) {
    const Index i = static_cast<Index>(r.clump);
    is_new[i] = true;
    state.clumps.shape[i] = r.shape;
    state.clumps.scale[i] = r.scale;
    state.clumps.material[i] = r.material;
    state.clumps.orientation[i] = r.orientation;
    weigh(model, state, r.clump);
  }
  forget_pairs(state.pair_blocks, [&](const ClumpPair& p) {
    return is_new[static_cast<Index>(p.i)] || is_new[static_cast<Index>(p.j)];
  });
  forget_pairs(state.wall_blocks, [&](const WallPair& p) { return is_new[static_cast<Index>(p.clump)]; });
}

void remove_clumps(State& state, const std::vector<int>& clumps) {
  Clumps& c = state.clumps;
  std::vector<bool> gone(c.id.size(), false);
  for (int k : clumps) gone[static_cast<Index>(k)] = true;
  std::vector<int> new_index(gone.size());
  int next = 0;
  for (Index k = 0; k < gone.size(); ++k) new_index[k] = gone[k] ? -1 : next++;

  forget_pairs(state.pair_blocks, [&](const ClumpPair& p) {
    return gone[static_cast<Index>(p.i)] || gone[static_cast<Index>(p.j)];
  });
  for (PairBlock& block : state.pair_blocks) {
    for (ClumpPair& p : block.pairs) {
      p.i = new_index[static_cast<Index>(p.i)];
      p.j = new_index[static_cast<Index>(p.j)];
    }
  }
  forget_pairs(state.wall_blocks, [&](const WallPair& p) { return gone[static_cast<Index>(p.clump)]; });
  for (WallBlock& block : state.wall_blocks) {
    for (WallPair& p : block.pairs) p.clump = new_index[static_cast<Index>(p.clump)];
  }
  erase_at(c.id, gone);
  erase_at(c.shape, gone);
  erase_at(c.material, gone);
  erase_at(c.scale, gone);
  erase_at(c.mass, gone);
  erase_at(c.inertial_mass, gone);
  erase_at(c.inertia, gone);
  erase_at(c.position, gone);
  erase_at(c.orientation, gone);
  erase_at(c.velocity, gone);
  erase_at(c.angular_momentum, gone);
  erase_at(c.angular_velocity, gone);
  erase_at(c.force, gone);
  erase_at(c.moment, gone);
  erase_at(c.losses, gone);
}

std::uint64_t hash(const State& state) {
  Hash h;
  const Clumps& c = state.clumps;
  h.add(c.next_id);
  for (Index i = 0; i < c.id.size(); ++i) {
    h.add(c.id[i]);
    h.add(c.shape[i]);
    h.add(c.material[i]);
    h.add(c.scale[i]);
    h.add(c.mass[i]);
    h.add(c.inertial_mass[i]);
    for (const Vec3* v :
         {&c.inertia[i], &c.position[i], &c.velocity[i], &c.angular_momentum[i], &c.force[i], &c.moment[i]})
      add(h, *v);
    add(h, c.orientation[i].coeffs());
    for (double loss : {c.losses[i].friction, c.losses[i].rolling, c.losses[i].dashpot, c.losses[i].damping})
      h.add(loss);
  }
  for (const WallState& w : state.walls) {
    h.add(w.present);
    h.add(w.held);
    for (const Vec3* v : {&w.pose.position, &w.velocity, &w.angular_velocity, &w.angular_momentum, &w.force,
                          &w.moment, &w.applied_force, &w.applied_moment})
      add(h, *v);
    add(h, w.pose.orientation.coeffs());
    for (double work : {w.applied_work, w.boundary_work, w.damping_loss}) h.add(work);
  }
  // Candidates out of touch depend on when a search ran, and say nothing.
  for (const PairBlock& block : state.pair_blocks)
    for (const ClumpPair& p : block.pairs)
      for (Index k = static_cast<Index>(p.first); k < static_cast<Index>(p.first + p.count); ++k) {
        if (!block.memory[k].touches()) continue;
        for (int part : {p.i, p.j, block.keys[k].a, block.keys[k].b}) h.add(part);
        add(h, block.memory[k]);
      }
  for (const WallBlock& block : state.wall_blocks)
    for (const WallPair& p : block.pairs)
      for (Index k = static_cast<Index>(p.first); k < static_cast<Index>(p.first + p.count); ++k)
        for (const ContactMemory& m : block.memory[k].points) {
          if (!m.touches()) continue;
          for (int part : {p.wall, p.clump, block.keys[k]}) h.add(part);
          add(h, m);
        }
  h.add(state.time);
  h.add(state.dt);
  h.add(state.planned_dt);
  h.add(state.step);
  h.add(state.next_look);
  return h.value();
}

}  // namespace trackbed
