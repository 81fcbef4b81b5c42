// SPDX-License-Identifier: BSD-3-Clause
#include <csom/eval/AkiMapMapper.h>
#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <array>
#include <cmath>
#include <set>
#include <vector>

#include "BaselineScans.h"

namespace csom {
namespace {

using namespace test;

/// AKIMap from its equations: all pairs, and scales one by one.
class NaiveAkiMap {
 public:
  NaiveAkiMap(const AkiMapParameters& parameters, const Options& input)
      : p_(parameters), r_(input.resolution), free_resolution_(input.free_space.resolution) {}

  void insert(const Scan& scan) {
    std::vector<Sample> samples;
    std::set<std::array<long, 3>> voxels;
    const auto addAll = [&](const std::vector<Eigen::Vector3d>& points, bool occupied) {
      for (const Eigen::Vector3d& x : points) {
        const std::array<long, 3> voxel{std::lround(std::floor(x.x() / r_)),
                                        std::lround(std::floor(x.y() / r_)),
                                        std::lround(std::floor(x.z() / r_))};
        if (voxels.insert(voxel).second) samples.push_back({x, occupied});
      }
    };
    addAll(hitsOf(scan), true);
    addAll({scan.origin}, false);
    addAll(freeSamplesOf(scan, free_resolution_), false);
    for (const Sample& sample : samples) fit(sample, samples, scan.origin);
  }

  /// α and β.
  std::pair<double, double> at(const Eigen::Vector3d& x) const {
    std::pair<double, double> counts{0, 0};
    for (const Kernel& kernel : kernels_) {
      const Eigen::Vector3d offset = x - kernel.sample.x;
      const double distance = std::sqrt(offset.dot(kernel.bandwidth.inverse() * offset));
      (kernel.sample.occupied ? counts.first : counts.second) +=
          sparseKernelInClosedForm(distance) / std::sqrt(kernel.bandwidth.determinant());
    }
    return counts;
  }

  int shrunk() const { return shrunk_; }

 private:
  struct Sample {
    Eigen::Vector3d x;
    bool occupied;
  };
  struct Kernel {
    Sample sample;
    Eigen::Matrix3d bandwidth;
  };

  void fit(const Sample& own, const std::vector<Sample>& samples, const Eigen::Vector3d& sensor) {
    const double share = std::min((own.x - sensor).norm() / p_.sensing_range, 1.0);
    const double radius = (1 - share) * r_ + share * p_.max_search_radius;
    std::vector<Sample> near;
    for (const Sample& other : samples)
      if ((other.x - own.x).norm() <= radius) near.push_back(other);
    Eigen::Matrix3d bandwidth = Eigen::Matrix3d::Zero();
    int alike = 0;
    for (const Sample& other : near) {
      if (other.occupied != own.occupied) continue;
      bandwidth += (other.x - own.x) * (other.x - own.x).transpose();
      ++alike;
    }
    if (alike < 3) {
      kernels_.push_back({own, r_ * r_ * Eigen::Matrix3d::Identity()});
      return;
    }
    bandwidth = bandwidth / (alike - 2) + p_.variance_noise * Eigen::Matrix3d::Identity();
    const double scale = bestScale(own, near, bandwidth);
    if (scale < 1) ++shrunk_;
    kernels_.push_back({own, scale * scale * bandwidth});
  }

  double bestScale(const Sample& own, const std::vector<Sample>& near,
                   const Eigen::Matrix3d& bandwidth) const {
    const double longest =
        std::sqrt(Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(bandwidth).eigenvalues()[2]);
    const double min = std::min(r_ / longest, 1.0);
    double best = 1;
    double least = cost(own, near, bandwidth, 1);
    for (int i = 1; i <= 32; ++i) {
      const double scale = std::exp(std::log(min) * i / 32);
      const double here = cost(own, near, bandwidth, scale);
      if (here < least - 1e-6) {
        least = here;
        best = scale;
      }
    }
    return best;
  }

  static double cost(const Sample& own, const std::vector<Sample>& near,
                     const Eigen::Matrix3d& bandwidth, double scale) {
    const Eigen::Matrix3d inverse = bandwidth.inverse();
    double squares = 0;
    for (const Sample& other : near) {
      const double d = std::sqrt((other.x - own.x).dot(inverse * (other.x - own.x)));
      if (d >= 1) continue;
      const double target = other.occupied == own.occupied ? sparseKernelInClosedForm(d) : 0;
      squares += std::pow(target - sparseKernelInClosedForm(d / scale), 2);
    }
    return squares / std::pow(scale, 3);
  }

  AkiMapParameters p_;
  double r_;
  double free_resolution_;
  std::vector<Kernel> kernels_;
  int shrunk_ = 0;
};

AkiMapParameters wideKernels() {
  AkiMapParameters parameters;
  parameters.max_search_radius = 0.8;
  parameters.sensing_range = 1.5;
  parameters.variance_noise = 0.002;
  parameters.prior = 100;  // of the order of the kernels' weights
  return parameters;
}

TEST(AkiMapMapper, EqualsTheSumOverAllKernels) {
  for (const std::uint64_t seed : {1, 2}) {
    const Options input = baselineInput(FreeSpace::Sampled);
    const AkiMapParameters parameters = wideKernels();
    AkiMapMapper mapper(input, parameters);
    NaiveAkiMap naive(parameters, input);
    for (const std::uint64_t scan : {seed, seed + 100}) {
      mapper.insert(randomScan(scan, 40));
      naive.insert(randomScan(scan, 40));
    }
    EXPECT_GT(naive.shrunk(), 10);
    int known = 0;
    forEachCenter(1.2, [&](const Eigen::Vector3d& center) {
      const auto [occupied, free] = naive.at(center);
      const VoxelEstimate voxel = mapper.at(center);
      expectPlainEstimate(voxel);
      if (occupied + free < 1e-3) return;
      EXPECT_TRUE(voxel.known);
      EXPECT_NEAR(voxel.occupancy, (100 + occupied) / (200 + occupied + free), 1e-3);
      ++known;
    });
    EXPECT_GT(known, 3000);
  }
}

/// A wall at x = 2, seen from the origin, with a hit every `step`.
Scan wall(float step) {
  Scan scan;
  for (float y = -0.775F; y < 0.8F; y += step)
    for (float z = -0.775F; z < 0.8F; z += step) {
      scan.points.emplace_back(2.05F, y, z);
      scan.labels.push_back(1);
    }
  return scan;
}

TEST(AkiMapMapper, KernelsAreLongWithinASurfaceAndThinAcrossIt) {
  AkiMapParameters parameters;
  parameters.max_search_radius = 0.6;
  parameters.sensing_range = 1;
  AkiMapMapper mapper(baselineInput(FreeSpace::None), parameters);
  mapper.insert(wall(0.3F));
  // Between hits that are three voxels apart the wall is closed …
  for (int y = -5; y <= 5; ++y) EXPECT_TRUE(mapper.at({2.05, 0.1 * y + 0.05, 0.05}).known) << y;
  // … and one voxel thick.
  for (const double x : {1.95, 2.15}) EXPECT_FALSE(mapper.at({x, 0.05, 0.05}).known) << x;
}

TEST(AkiMapMapper, FreeSamplesBesideAWallTakeItsEdgeBack) {
  AkiMapParameters parameters;
  parameters.max_search_radius = 0.6;
  parameters.sensing_range = 1;
  Scan scan = wall(0.3F);
  AkiMapMapper alone(baselineInput(FreeSpace::None), parameters);
  alone.insert(scan);
  ASSERT_TRUE(alone.at({2.05, 0.95, 0.05}).known);  // beyond the last hits, at 0.725
  // Free points beside the wall's edge.
  for (float z = -0.775F; z < 0.8F; z += 0.05F) {
    scan.points.emplace_back(2.05F, 0.85F, z);
    scan.labels.push_back(kFreeClass);
  }
  AkiMapMapper beside(baselineInput(FreeSpace::None), parameters);
  beside.insert(scan);
  EXPECT_LT(beside.at({2.05, 0.85, 0.05}).occupancy, 0.1);
  EXPECT_GT(beside.at({2.05, 0.05, 0.05}).occupancy, 0.9);
  EXPECT_GT(alone.at({2.05, 0.85, 0.05}).occupancy, 0.9);
}

TEST(AkiMapMapper, ALoneHitIsOccupiedItsBeamFreeAndTheRestUnknown) {
  AkiMapMapper mapper(baselineInput(FreeSpace::Sampled));
  mapper.insert(scanOf({2.05F, 0.05F, 0.05F}));
  EXPECT_EQ(mapper.at({2.05, 0.05, 0.05}).class_id, 1);
  EXPECT_GT(mapper.at({2.05, 0.05, 0.05}).occupancy, 0.99);
  EXPECT_TRUE(mapper.at({1.15, 0.05, 0.05}).known);
  EXPECT_LT(mapper.at({1.15, 0.05, 0.05}).occupancy, 0.01);
  EXPECT_TRUE(mapper.at({0.05, 0.05, 0.05}).known);  // the sensor's own place
  EXPECT_FALSE(mapper.at({1.15, 0.55, 0.05}).known);
  EXPECT_FALSE(mapper.at({2.45, 0.05, 0.05}).known);
}

TEST(AkiMapMapper, WithoutFreeSpaceHitsAreAllThatIsKnown) {
  AkiMapMapper mapper(baselineInput(FreeSpace::None));
  mapper.insert(scanOf({2.05F, 0.05F, 0.05F}));
  EXPECT_EQ(mapper.at({2.05, 0.05, 0.05}).class_id, 1);
  EXPECT_FALSE(mapper.at({1.15, 0.05, 0.05}).known);
  EXPECT_FALSE(mapper.at({0.05, 0.05, 0.05}).known);
}

TEST(AkiMapMapper, TheOrderOfScansDoesNotMatter) {
  AkiMapMapper forward(baselineInput(FreeSpace::Sampled), wideKernels());
  AkiMapMapper backward(baselineInput(FreeSpace::Sampled), wideKernels());
  for (std::uint64_t seed = 0; seed < 4; ++seed) {
    forward.insert(randomScan(seed, 20));
    backward.insert(randomScan(3 - seed, 20));
  }
  forEachCenter(1.2, [&](const Eigen::Vector3d& center) {
    EXPECT_EQ(forward.at(center).known, backward.at(center).known);
    EXPECT_NEAR(forward.at(center).occupancy, backward.at(center).occupancy, 1e-9);
  });
}

TEST(AkiMapMapper, RejectsWhatCannotBe) {
  AkiMapParameters parameters;
  parameters.max_search_radius = 0.01;  // less than a voxel
  EXPECT_THROW(AkiMapMapper(baselineInput(FreeSpace::None), parameters), OptionError);
  parameters = {};
  parameters.sensing_range = 0;
  EXPECT_THROW(AkiMapMapper(baselineInput(FreeSpace::None), parameters), OptionError);
}

}  // namespace
}  // namespace csom
