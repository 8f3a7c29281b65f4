// Twelve bays of track on finite elements of ground: the ground in full order and reduced, under two axles.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <vector>

#include "fem/soil_parts.h"
#include "scenes/track_scene.h"

namespace trackbed::fem {
namespace {

constexpr int sleepers = 12, patches = 4;

SoilInput strip() {
  SoilInput in;
  in.element_size = 0.15;
  in.length = 0.6 * sleepers;
  in.subgrade_depth = 0.6;
  in.sleepers = sleepers;
  in.first_sleeper = 0.3;
  in.sleeper_width = 0.3;
  in.end = Support::absorbing;
  in.mass_damping = 10;
  return in;
}

/// Sleepers, rail and ground; two axles roll from bay 3 to bay 9.
struct Strip {
  CoupledSystem system;
  Beam rail;
  Index first_rail = 0;
  std::vector<Index> contacts, axles;  // first contact of each sleeper

  explicit Strip(std::unique_ptr<Part> ground_part)
      : rail(thesis_track().rail, even_nodes(0, 0.6 * sleepers, 4 * sleepers), BeamEnd::free, BeamEnd::free) {
    first_rail = system.add(std::make_unique<SparsePart>(rail.structure(9.81)));
    const Index ground = system.add(std::move(ground_part));
    for (int s = 0; s < sleepers; ++s) {
      const Index sleeper = system.add([] {
        Structure<MatrixXd> block{MatrixXd::Constant(1, 1, 140), MatrixXd::Zero(1, 1), MatrixXd::Zero(1, 1),
                                  VectorXd::Constant(1, -140 * 9.81), MatrixXd::Ones(1, 1)};
        return std::make_unique<DensePart>(std::move(block));
      }());
      std::vector<LinkEnd> ends = rail.at(0.3 + 0.6 * s, first_rail, -1);
      ends.push_back({sleeper, 1.0});
      system.add(Link{ClampedSpring{1.2e8, 1.2e11, 5e4}, std::move(ends), 0, s});
      contacts.push_back(system.links());
      for (int p = 0; p < patches; ++p)
        system.add(
            Link{OneSidedSpring{4e8 / patches}, {{sleeper, -1.0}, {ground + s * patches + p, 1.0}}, 0, s});
    }
    for (const double behind : {0.0, 2.5})
      axles.push_back(system.add(Link{GivenForce{93e3}, rail.at(4.5 - behind, first_rail, 1), 0}));
  }

  /// Largest force of each sleeper on its way.
  std::vector<double> peaks(double dt) {
    system.find_rest();
    system.move_by({dt, 0});
    std::vector<double> peak(sleepers, 0);
    for (double x = 4.5; x < 6.5;) {
      const double share = std::min(1.0, system.time() / 0.02);
      x += 40 * share * share * (3 - 2 * share) * dt;
      for (std::size_t a = 0; a < 2; ++a)
        system.move_ends(axles[a], rail.at(x - 2.5 * double(a), first_rail, 1));
      system.step();
      for (std::size_t s = 0; s < peak.size(); ++s)
        peak[s] = std::max(peak[s], system.forces().segment(contacts[s], patches).sum());
    }
    return peak;
  }
};

TEST(TrackStrip, ReducedGroundGivesTheForcesOfTheWholeOne) {
  const Soil soil = make_soil(strip());
  const ReducedSoil reduced = reduce(soil);
  Strip in_few(make_reduced_part(soil, reduced, patches));
  Strip in_full(std::make_unique<ExplicitPart>(soil, make_reduced_part(soil, reduced, patches), patches));
  const double dt = 1.5e-4;
  const std::vector<double> few = in_few.peaks(dt), full = in_full.peaks(dt);
  const double largest = *std::ranges::max_element(full);
  EXPECT_GT(largest, 20e3);
  for (std::size_t s = 0; s < full.size(); ++s) EXPECT_NEAR(few[s], full[s], 0.01 * largest) << s;
}

TEST(TrackStrip, PatchesShareAFootingsNodes) {
  const Soil soil = make_soil(strip());
  const MatrixXd shares = patch_shares(soil, patches);
  EXPECT_TRUE(shares.colwise().sum().isOnes(1e-12));
  EXPECT_GE(shares.minCoeff(), 0);
  // All patches together load nodes as an even pressure does.
  const VectorXd all = shares.rowwise().mean();
  EXPECT_TRUE(all.isApprox(soil.area / soil.area.sum(), 1e-12));
}

}  // namespace
}  // namespace trackbed::fem
