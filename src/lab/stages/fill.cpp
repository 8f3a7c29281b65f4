#include <fmt/format.h>

#include <algorithm>
#include <optional>
#include <unordered_map>

#include "base/error.h"
#include "base/rng.h"
#include "dem/overlap.h"
#include "io/read.h"
#include "lab/case.h"
#include "lab/checks.h"
#include "lab/grading.h"
#include "lab/room.h"
#include "lab/stages/table.h"

namespace trackbed {
namespace {

struct FillInput : StageInput {
  double porosity = 0.4;
  double density = 0.22;
  double clearance = 0.2e-3;  // [m]
  std::string set;            // empty: that of [stones]

  /// Of the stones that fill the container [m], the largest first.
  std::vector<double> sizes(const StonesInput& stones, const Simulation& sim) const {
    Rng rng(sim.seed, "sizes");
    return draw_sizes(stones.grading, sim.model.space, (1.0 - porosity) * sim.container.volume(), rng);
  }
  void check(const Document& document, const CaseInput& experiment, const Simulation& sim) const override;
  std::unique_ptr<Stage> make(const CaseInput& experiment) const override;
};

void declare(Fields& f, FillInput& in) {
  declare_common(f, in);
  f.number("porosity", in.porosity, {.above = 0, .below = 1},
           "nominal: the stones' volume is (1 - porosity) x the volume of the container");
  f.number("density", in.density, {.above = 0, .at_most = 0.3},
           "share of the column above the floor that the falling stones take up");
  f.quantity("clearance", in.clearance, Dimension::length, {.above = 0}, "left free between stones");
  f.text("set", in.set, "a set of stones.sets to take the stones from; by default those of [stones]");
  f.gives("added", Dimension::none, "stones");
  f.gives("column_height", Dimension::length, "of the column that they are placed in");
  declare_passing(f);
}

/// Places stones of the given sizes at random, none touching another or a wall, in a column over the
/// container's floor (random sequential addition, the largest first).
class Fill : public Stage {
 public:
  Fill(const FillInput& in, const CaseInput& experiment) : in_(in), stones_(experiment.stones) {}

  void open(Simulation& sim) override {
    Rng rng(sim.seed, "places");
    set_ = sim.stone_set(in_.set);
    sizes_ = in_.sizes(stones_, sim);
    double volume = 0;
    for (double size : sizes_) volume += sim.model.space.volume_of_size(size);
    const Vec3 extent = sim.container.sizes();
    column_ = sim.container;
    column_.max().z() =
        column_.min().z() + volume / (in_.density * extent.x() * extent.y()) + 2.0 * sizes_.front();
    cell_ = largest_bound(sim);
    for (int stone = 0; stone < sim.state.clumps.size(); ++stone) remember(sim, stone);
    for (double size : sizes_) place(sim, size, rng);
    sim.model.domain.extend(column_);
    sim.changed();
  }

  bool finished(const Simulation&) override { return true; }

  std::vector<Result> close(Simulation& sim) override {
    std::vector<Result> results{{"added", static_cast<double>(sizes_.size()), Dimension::none},
                                {"column_height", column_.sizes().z(), Dimension::length}};
    for (const Result& r : passing_results(stones_.grading, sim.model.space, sizes_)) results.push_back(r);
    return results;
  }
  void archive(Archive& a) override { a(sizes_, column_); }

 private:
  using Cell = std::int64_t;

  double largest_bound(const Simulation& sim) const {
    double bound = 0;
    for (int shape = set_.first; shape < set_.first + set_.count; ++shape) {
      const ClumpTemplate& t = sim.model.templates[static_cast<std::size_t>(shape)];
      bound = std::max(
          bound, t.bounding_radius * scale_to_size(stones_.grading, sim.model.space, t, sizes_.front()));
    }
    const Clumps& there = sim.state.clumps;  // from an earlier stage
    for (std::size_t c = 0; c < there.id.size(); ++c)
      bound =
          std::max(bound, there.scale[c] *
                              sim.model.templates[static_cast<std::size_t>(there.shape[c])].bounding_radius);
    return 2.0 * bound + in_.clearance;
  }

  Cell cell_at(std::int64_t x, std::int64_t y, std::int64_t z) const {
    return (x * 1048576 + y) * 1048576 + z;
  }
  std::array<std::int64_t, 3> place_of(const Vec3& p) const {
    const Vec3 at = ((p - column_.min()) / cell_).array().floor();
    return {static_cast<std::int64_t>(at.x()) + 2, static_cast<std::int64_t>(at.y()) + 2,
            static_cast<std::int64_t>(at.z()) + 2};
  }

  bool is_free(const Simulation& sim, int stone) const {
    if (!is_clear_of_walls(sim, stone, in_.clearance)) return false;
    const auto [x, y, z] = place_of(sim.state.clumps.position[static_cast<std::size_t>(stone)]);
    for (std::int64_t dx = -1; dx <= 1; ++dx)
      for (std::int64_t dy = -1; dy <= 1; ++dy)
        for (std::int64_t dz = -1; dz <= 1; ++dz) {
          const auto cell = cells_.find(cell_at(x + dx, y + dy, z + dz));
          if (cell == cells_.end()) continue;
          for (int other : cell->second)
            if (stones_meet(sim.model, sim.state.clumps, stone, other, in_.clearance)) return false;
        }
    return true;
  }

  void place(Simulation& sim, double size, Rng& rng) {
    const int shape = set_.first + static_cast<int>(rng.index(static_cast<std::uint32_t>(set_.count)));
    const ClumpTemplate& stone_shape = sim.model.templates[static_cast<std::size_t>(shape)];
    const double scale = scale_to_size(stones_.grading, sim.model.space, stone_shape, size);
    const int stone = add_clump(sim.model, sim.state, shape, scale, set_.material, {});
    Clumps& c = sim.state.clumps;
    const auto k = static_cast<std::size_t>(stone);
    constexpr int tries_before_growth = 500;
    for (int tries = 1;; ++tries) {
      const double x = rng.uniform(column_.min().x(), column_.max().x()),
                   y = rng.uniform(column_.min().y(), column_.max().y()),
                   z = rng.uniform(column_.min().z(), column_.max().z());
      c.position[k] = sim.model.space.nearest({x, y, z});
      c.orientation[k] = sim.model.space.turn(rng);
      if (is_free(sim, stone)) break;
      // No room: a higher column.
      if (tries % tries_before_growth == 0) column_.max().z() += 0.05 * column_.sizes().z();
      if (tries > 100 * tries_before_growth)
        throw InputError(fmt::format("stage {}: a stone of {:.1f} mm does not fit into the container",
                                     in_.name, 1e3 * size));
    }
    remember(sim, stone);
  }

  void remember(const Simulation& sim, int stone) {
    const auto [x, y, z] = place_of(sim.state.clumps.position[static_cast<std::size_t>(stone)]);
    cells_[cell_at(x, y, z)].push_back(stone);
  }

  FillInput in_;
  StonesInput stones_;
  StoneSet set_;
  std::vector<double> sizes_;  // [m]
  Eigen::AlignedBox3d column_;
  double cell_ = 0;  // [m]
  std::unordered_map<Cell, std::vector<int>> cells_;
};

void FillInput::check(const Document& document, const CaseInput& experiment, const Simulation& sim) const {
  if (!set.empty()) check_stone_set(document, experiment, here + ".set", set);
  check_room(document, here, sim);
  if (sim.container_mesh >= 0 || !sim.trays.empty())
    document.fail(here + ".kind", "a column of stones falls into a box only",
                  "use the stage scatter, which places stones inside");
  const double largest = experiment.stones.grading.scale * experiment.stones.grading.sieves.back();
  const double fewest = (1.0 - porosity) * sim.container.volume() / sim.model.space.volume_of_size(largest);
  if (fewest > 1e8)
    document.fail(here, "the container takes more than a hundred million stones",
                  "check the size of the container and the sieves");
  if (sizes(experiment.stones, sim).empty())
    document.fail(here + ".porosity", "no stone is left: the container is too small for the grading",
                  "make the container larger, the porosity lower or the stones smaller");
}

std::unique_ptr<Stage> FillInput::make(const CaseInput& experiment) const {
  return std::make_unique<Fill>(*this, experiment);
}

}  // namespace

Kind<StageInput> fill_stage() {
  return kind_of<StageInput, FillInput>(
      "fill", "fills a column over the container with stones by the grading, none touching");
}

}  // namespace trackbed
