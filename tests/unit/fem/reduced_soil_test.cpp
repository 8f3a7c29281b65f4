#include "fem/reduced_soil.h"

#include <gtest/gtest.h>
#include <omp.h>

#include <fstream>

#include "base/error.h"
#include "fem/explicit_soil.h"
#include "scenes/strip_of_soil.h"

namespace trackbed::fem {
namespace {

/// Displacements of footings at rest under forces on their nodes.
Eigen::VectorXd rest(const ReducedSoil& r, const Eigen::VectorXd& forces) {
  return r.nodes * (r.nodes.transpose() * forces).cwiseQuotient(r.stiffness);
}

Eigen::VectorXd pressed(const Soil& soil, int footing, int shape) {
  Eigen::VectorXd f = Eigen::VectorXd::Zero(soil.footings() * soil.nodes_per_footing());
  f.segment(footing * soil.nodes_per_footing(), soil.nodes_per_footing()) =
      1e4 * soil.shape_forces.col(shape);
  return f;
}

Eigen::VectorXd full_rest(const Soil& soil, const Eigen::VectorXd& forces) {
  ExplicitSoil full(soil);
  full.start(forces, 0.5 * stable_time_step(soil));
  return full.displacement();
}

// What the static columns are for: rest under each pressure shape is that of the full model.
TEST(ReducedSoil, RestUnderPressureShapesIsExact) {
  const Soil soil = make_soil(strip_of_soil());
  const ReducedSoil r = reduce(soil, {1, 1, 18});
  EXPECT_EQ(r.nodes.rows(), 5 * 21);
  for (int shape : {0, 2, 5}) {
    const Eigen::VectorXd f = pressed(soil, 1, shape), wanted = full_rest(soil, f);
    EXPECT_LT((rest(r, f) - wanted).norm(), 1e-7 * wanted.norm());
  }
}

// Of a soil longer than the windows, footings in the middle share columns; what is cut off matters little.
TEST(ReducedSoil, WindowsStandForTheWhole) {
  SoilInput in = strip_of_soil();
  in.length = 9;
  in.sleepers = 15;
  in.start = Support::fixed;
  const Soil soil = make_soil(in);
  Eigen::Vector3d before = Eigen::Vector3d::Ones();
  for (double window : {2.4, 4.2, 6.0}) {
    const ReducedSoil r = reduce(soil, {0, 0, window});
    for (int i = 0; i < 3; ++i) {
      const Eigen::VectorXd f = pressed(soil, i * 6 + 1, 0), wanted = full_rest(soil, f);
      const double error = (rest(r, f) - wanted).norm() / wanted.norm();
      EXPECT_LT(error, before[i] / 2) << i << " " << window;
      before[i] = error;
    }
  }
  EXPECT_LT(before.maxCoeff(), 1e-3);
}

TEST(ReducedSoil, SameBitsOnAnyNumberOfThreads) {
  const Soil soil = make_soil(strip_of_soil());
  const int threads = omp_get_max_threads();
  omp_set_num_threads(1);
  const ReducedSoil one = reduce(soil, {1, 2, 2.4});
  omp_set_num_threads(3);
  const ReducedSoil three = reduce(soil, {1, 2, 2.4});
  omp_set_num_threads(threads);
  EXPECT_EQ(one.stiffness, three.stiffness);
  EXPECT_EQ(one.nodes, three.nodes);
  EXPECT_EQ(one.damping, three.damping);
  EXPECT_EQ(one.gravity, three.gravity);
}

TEST(ReducedSoil, IsKeptInAFileAndReadBack) {
  const std::filesystem::path folder = std::filesystem::path(testing::TempDir()) / "trackbed-reduced-soil";
  std::filesystem::remove_all(folder);
  SoilInput in = strip_of_soil();
  EXPECT_FALSE(is_kept(make_soil(in), {0, 0, 18}, folder));
  const ReducedSoil made = reduce(make_soil(in), {0, 0, 18}, folder);
  EXPECT_TRUE(is_kept(make_soil(in), {0, 0, 18}, folder));
  EXPECT_FALSE(is_kept(make_soil(in), {1, 0, 18}, folder));
  EXPECT_FALSE(is_kept(make_soil(in), {0, 0, 18, 100}, folder));
  auto files = [&] {
    return std::distance(std::filesystem::directory_iterator(folder), std::filesystem::directory_iterator());
  };
  ASSERT_EQ(files(), 1);
  const std::filesystem::path file = std::filesystem::directory_iterator(folder)->path();
  const auto time = std::filesystem::last_write_time(file);
  const ReducedSoil read = reduce(make_soil(in), {0, 0, 18}, folder);
  EXPECT_EQ(std::filesystem::last_write_time(file), time);
  EXPECT_EQ(read.stiffness, made.stiffness);
  EXPECT_EQ(read.damping, made.damping);
  EXPECT_EQ(read.nodes, made.nodes);
  EXPECT_EQ(read.gravity, made.gravity);

  in.subgrade.young *= 2;  // another soil, another file
  EXPECT_NE(reduce(make_soil(in), {0, 0, 18}, folder).stiffness, made.stiffness);
  EXPECT_EQ(files(), 2);
  in.subgrade.young /= 2;

  std::fstream(file, std::ios::in | std::ios::out | std::ios::binary)
      .seekp(400)
      .put('x');  // damaged: made again
  EXPECT_EQ(reduce(make_soil(in), {0, 0, 18}, folder).stiffness, made.stiffness);
  std::filesystem::resize_file(file, 1000);
  EXPECT_EQ(reduce(make_soil(in), {0, 0, 18}, folder).stiffness, made.stiffness);
  std::filesystem::remove_all(folder);
  EXPECT_THROW(reduce(make_soil(in), {0, 0, 18}, "/proc/nowhere"), RunError);
}

TEST(ReducedSoil, WrongInputIsNamed) {
  const Soil soil = make_soil(strip_of_soil());
  EXPECT_THROW(reduce(soil, {-1, 0, 18}), InputError);
  EXPECT_THROW(reduce(soil, {0, -1, 18}), InputError);
  EXPECT_THROW(reduce(soil, {0, 0, 0.2}), InputError);
  EXPECT_THROW(reduce(soil, {0, 0, 18, -1}), InputError);
}

}  // namespace
}  // namespace trackbed::fem
