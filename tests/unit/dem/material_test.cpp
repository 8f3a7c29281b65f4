#include "dem/material.h"

#include <gtest/gtest.h>

namespace trackbed {
namespace {

const std::vector<Material> stone_and_steel{{"stone", 4e6, 2e6, 0.7, 0.2, 2650},
                                            {"steel", 12e6, 6e6, 0.3, 0.1, 7850}};

TEST(PairTable, PiecesAreSpringsInSeriesWithTheSmallerFriction) {
  const PairTable table(stone_and_steel, LawKind::linear_rolling, {0.1, 0.2, DashpotMode::no_tension});
  EXPECT_EQ(table.size(), 2);
  EXPECT_DOUBLE_EQ(table(0, 0).kn, 2e6);
  EXPECT_DOUBLE_EQ(table(0, 0).ks, 1e6);
  EXPECT_DOUBLE_EQ(table(0, 0).friction, 0.7);
  EXPECT_DOUBLE_EQ(table(1, 1).kn, 6e6);
  for (const auto& [a, b] : {std::pair{0, 1}, {1, 0}}) {
    const ContactProperties& p = table(a, b);
    EXPECT_EQ(p.law, LawKind::linear_rolling);
    EXPECT_DOUBLE_EQ(p.kn, 3e6);    // 4 x 12/16
    EXPECT_DOUBLE_EQ(p.ks, 1.5e6);  // 2 x 6/8
    EXPECT_DOUBLE_EQ(p.friction, 0.3);
    EXPECT_DOUBLE_EQ(p.rolling_friction, 0.1);
    EXPECT_EQ(p.dashpot.normal, 0.1);
    EXPECT_EQ(p.dashpot.shear, 0.2);
    EXPECT_EQ(p.dashpot.mode, DashpotMode::no_tension);
  }
}

TEST(PairTable, ContactValuesAreTakenAsTheyStand) {
  const PairTable table(stone_and_steel, LawKind::linear, {}, Inheritance::contact);
  EXPECT_EQ(table(0, 0).kn, 4e6);
  EXPECT_EQ(table(0, 0).ks, 2e6);
  EXPECT_EQ(table(0, 1).kn, 4e6);  // the stone's against a stiffer wall
  EXPECT_EQ(table(1, 0).ks, 2e6);
  EXPECT_EQ(table(0, 1).friction, 0.3);
}

TEST(PairTable, WithoutStiffnessOnOneSideThereIsNone) {
  std::vector<Material> m = stone_and_steel;
  m[1].kn = m[1].ks = 0;
  for (Inheritance inheritance : {Inheritance::series, Inheritance::contact}) {
    const PairTable table(m, LawKind::linear, {}, inheritance);
    EXPECT_EQ(table(0, 1).kn, 0);
    EXPECT_EQ(table(1, 0).ks, 0);
    EXPECT_EQ(table(1, 1).kn, 0);  // and no 0/0
    EXPECT_GT(table(0, 0).kn, 0);
  }
}

TEST(PairTable, StiffestLooksAtNormalAndShearOfAllPartners) {
  const PairTable table(stone_and_steel, LawKind::linear, {});
  EXPECT_DOUBLE_EQ(table.stiffest(0), 3e6);
  EXPECT_DOUBLE_EQ(table.stiffest(1), 6e6);
  const PairTable sheared({{"glue", 1e6, 8e6, 0, 0, 1000}}, LawKind::linear, {});
  EXPECT_DOUBLE_EQ(sheared.stiffest(0), 4e6);
}

// Clumps without rolling resistance beside balls with it.
TEST(PairTable, RollsOnlyWhereBothPiecesResistRolling) {
  const PairTable table({{"clump", 1e6, 1e6, 0.5, 0, 2600}, {"ball", 1e6, 1e6, 0.5, 0.3, 2600}},
                        LawKind::linear_rolling, {});
  EXPECT_EQ(table(0, 0).law, LawKind::linear);
  EXPECT_EQ(table(0, 1).law, LawKind::linear);
  EXPECT_EQ(table(1, 1).law, LawKind::linear_rolling);
}

}  // namespace
}  // namespace trackbed
