// SPDX-License-Identifier: BSD-3-Clause
#include <csom/eval/GpOctoMapMapper.h>
#include <gtest/gtest.h>

#include <Eigen/LU>
#include <array>
#include <cmath>
#include <map>
#include <utility>

#include "BaselineScans.h"

namespace csom {
namespace {

using namespace test;

/// GPOctoMap from its equations: an inverse for each block, every voxel asks the blocks around it.
class NaiveGpOctoMap {
 public:
  using Cell = std::array<int, 3>;

  NaiveGpOctoMap(const GpOctoMapParameters& parameters, double resolution)
      : p_(parameters), block_edge_(resolution * std::pow(2, parameters.block_depth - 1)) {}

  void insert(const Scan& scan, double free_resolution) {
    std::map<Cell, Points> blocks;
    for (const Eigen::Vector3d& hit : hitsOf(scan)) blocks[cellOf(hit)].emplace_back(hit, 1);
    for (const Eigen::Vector3d& point : freeSamplesOf(scan, free_resolution))
      blocks[cellOf(point)].emplace_back(point, -1);
    scans_.push_back(blocks);
  }

  /// Mean and variance.
  std::pair<double, double> at(const Eigen::Vector3d& x) const {
    double information = 1 / p_.signal_variance;
    double information_mean = 0;
    for (const std::map<Cell, Points>& scan : scans_)
      for (const auto& [cell, points] : scan) {
        const Cell own = cellOf(x);
        if (std::abs(cell[0] - own[0]) + std::abs(cell[1] - own[1]) + std::abs(cell[2] - own[2]) >
            1)
          continue;
        const auto [mean, variance] = predict(points, x);
        information += 1 / variance - 1 / p_.signal_variance;
        information_mean += mean / variance;
      }
    return {information_mean / information, 1 / information};
  }

 private:
  using Points = std::vector<std::pair<Eigen::Vector3d, double>>;

  Cell cellOf(const Eigen::Vector3d& x) const {
    return {static_cast<int>(std::floor(x.x() / block_edge_)),
            static_cast<int>(std::floor(x.y() / block_edge_)),
            static_cast<int>(std::floor(x.z() / block_edge_))};
  }

  double kernel(const Eigen::Vector3d& a, const Eigen::Vector3d& b) const {
    const double d = std::sqrt(3) * (a - b).norm() / p_.kernel_length;
    return p_.signal_variance * (1 + d) * std::exp(-d);
  }

  std::pair<double, double> predict(const Points& points, const Eigen::Vector3d& x) const {
    const auto n = static_cast<Eigen::Index>(points.size());
    Eigen::MatrixXd k(n, n);
    Eigen::VectorXd to_x(n);
    Eigen::VectorXd y(n);
    for (Eigen::Index i = 0; i < n; ++i) {
      const auto& [a, label] = points[static_cast<std::size_t>(i)];
      for (Eigen::Index j = 0; j < n; ++j)
        k(i, j) = kernel(a, points[static_cast<std::size_t>(j)].first);
      k(i, i) += p_.noise_variance;
      to_x[i] = kernel(a, x);
      y[i] = label;
    }
    const Eigen::MatrixXd inverse = k.fullPivLu().inverse();
    return {to_x.dot(inverse * y), p_.signal_variance - to_x.dot(inverse * to_x)};
  }

  GpOctoMapParameters p_;
  double block_edge_;
  std::vector<std::map<Cell, Points>> scans_;
};

GpOctoMapParameters allKnown() {
  GpOctoMapParameters parameters;
  parameters.max_known_variance = 1e9;
  return parameters;
}

TEST(GpOctoMapMapper, EqualsTheDenseSolution) {
  for (const int block_depth : {1, 2, 3, 4}) {
    const Options input = baselineInput(FreeSpace::Sampled);
    GpOctoMapParameters parameters = allKnown();
    parameters.block_depth = block_depth;
    parameters.kernel_length = 0.2 * block_depth;
    parameters.noise_variance = 0.05;
    GpOctoMapMapper mapper(input, parameters);
    NaiveGpOctoMap naive(parameters, input.resolution);
    for (const std::uint64_t seed : {1, 2}) {
      mapper.insert(randomScan(seed, 30));
      naive.insert(randomScan(seed, 30), input.free_space.resolution);
    }
    int known = 0;
    forEachCenter(1.5, [&](const Eigen::Vector3d& center) {
      const auto [mean, variance] = naive.at(center);
      const VoxelEstimate voxel = mapper.at(center);
      expectPlainEstimate(voxel);
      EXPECT_EQ(voxel.known, variance < parameters.signal_variance);
      if (!voxel.known) return;
      const double expected = 1 / (1 + std::exp(-0.1 * mean / variance));
      EXPECT_NEAR(voxel.occupancy, expected, 1e-4);
      ++known;
    });
    EXPECT_GT(known, 200);
  }
}

TEST(GpOctoMapMapper, ThresholdsTheVariance) {
  GpOctoMapParameters parameters;
  parameters.max_known_variance = 0.3;
  const Options input = baselineInput(FreeSpace::Sampled);
  GpOctoMapMapper mapper(input, parameters);
  NaiveGpOctoMap naive(parameters, input.resolution);
  mapper.insert(randomScan(5, 30));
  naive.insert(randomScan(5, 30), input.free_space.resolution);
  int known = 0;
  int unknown = 0;
  forEachCenter(1.5, [&](const Eigen::Vector3d& center) {
    const double variance = naive.at(center).second;
    if (std::abs(variance - 0.3) < 1e-4) return;
    EXPECT_EQ(mapper.at(center).known, variance < 0.3);
    if (variance < 0.3) {
      ++known;
    } else if (variance < 1) {
      ++unknown;
    }
  });
  EXPECT_GT(known, 100);
  EXPECT_GT(unknown, 100);
}

TEST(GpOctoMapMapper, AHitIsOccupiedItsBeamFreeAndTheRestUnknown) {
  GpOctoMapMapper mapper(baselineInput(FreeSpace::Sampled));
  for (int n = 0; n < 3; ++n) mapper.insert(scanOf({2.05F, 0.05F, 0.05F}));
  EXPECT_EQ(mapper.at({2.05, 0.05, 0.05}).class_id, 1);
  EXPECT_GT(mapper.at({2.05, 0.05, 0.05}).occupancy, 0.99);
  EXPECT_TRUE(mapper.at({1.15, 0.05, 0.05}).known);
  EXPECT_LT(mapper.at({1.15, 0.05, 0.05}).occupancy, 0.01);
  EXPECT_FALSE(mapper.at({1.15, 1.55, 0.05}).known);
  EXPECT_FALSE(mapper.at({3.25, 0.05, 0.05}).known);
}

TEST(GpOctoMapMapper, WithoutFreeSpaceHitsAreAllThatIsKnown) {
  GpOctoMapMapper mapper(baselineInput(FreeSpace::None), allKnown());
  mapper.insert(scanOf({2.05F, 0.05F, 0.05F}));
  EXPECT_GT(mapper.at({2.05, 0.05, 0.05}).occupancy, 0.99);
  EXPECT_FALSE(mapper.at({1.05, 0.05, 0.05}).known);
}

TEST(GpOctoMapMapper, TheOrderOfScansDoesNotMatter) {
  GpOctoMapMapper forward(baselineInput(FreeSpace::Sampled), allKnown());
  GpOctoMapMapper backward(baselineInput(FreeSpace::Sampled), allKnown());
  for (std::uint64_t seed = 0; seed < 4; ++seed) {
    forward.insert(randomScan(seed, 20));
    backward.insert(randomScan(3 - seed, 20));
  }
  forEachCenter(1.2, [&](const Eigen::Vector3d& center) {
    EXPECT_EQ(forward.at(center).known, backward.at(center).known);
    EXPECT_NEAR(forward.at(center).occupancy, backward.at(center).occupancy, 1e-9);
  });
}

TEST(GpOctoMapMapper, PointsThatCoincideAreNoTrouble) {
  GpOctoMapMapper mapper(baselineInput(FreeSpace::None));
  Scan scan = scanOf({2.05F, 0.05F, 0.05F});
  scan.points.resize(50, scan.points.front());
  scan.labels.resize(50, 1);
  mapper.insert(scan);
  const VoxelEstimate voxel = mapper.at({2.05, 0.05, 0.05});
  EXPECT_TRUE(voxel.known);
  EXPECT_GT(voxel.occupancy, 0.99);
}

TEST(GpOctoMapMapper, RejectsWhatCannotBe) {
  GpOctoMapParameters parameters;
  parameters.noise_variance = 0;
  EXPECT_THROW(GpOctoMapMapper(baselineInput(FreeSpace::None), parameters), OptionError);
  parameters = {};
  parameters.block_depth = 9;
  EXPECT_THROW(GpOctoMapMapper(baselineInput(FreeSpace::None), parameters), OptionError);
}

}  // namespace
}  // namespace csom
