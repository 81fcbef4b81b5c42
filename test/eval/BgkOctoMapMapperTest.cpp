// SPDX-License-Identifier: BSD-3-Clause
#include <csom/eval/BgkOctoMapMapper.h>
#include <gtest/gtest.h>

#include <algorithm>

#include "BaselineScans.h"

namespace csom {
namespace {

using namespace test;

double distanceToSegment(const Eigen::Vector3d& point, const Eigen::Vector3d& a,
                         const Eigen::Vector3d& b) {
  const double t = std::clamp((point - a).dot(b - a) / (b - a).squaredNorm(), 0.0, 1.0);
  return (point - a - t * (b - a)).norm();
}

/// α and β of one voxel, over all training points.
struct NaiveCounts {
  double occupied = 0;
  double free = 0;
  double nearest = 10;  ///< distance of a training point in kernel lengths

  void add(const Scan& scan, const Eigen::Vector3d& center, double length, double free_resolution) {
    for (const Eigen::Vector3d& hit : hitsOf(scan)) {
      occupied += kernel((center - hit).norm() / length);
      const Eigen::Vector3d beam = hit - scan.origin;
      if (beam.norm() <= free_resolution) continue;
      const Eigen::Vector3d end = hit - free_resolution * beam.normalized();
      free += kernel(distanceToSegment(center, scan.origin, end) / length);
    }
  }

 private:
  double kernel(double t) {
    nearest = std::min(nearest, t);
    return sparseKernelInClosedForm(t);
  }
};

TEST(BgkOctoMapMapper, EqualsTheSumOverAllTrainingPoints) {
  for (const std::uint64_t seed : {1, 2, 3}) {
    const Options input = baselineInput(FreeSpace::Sampled);
    BgkOctoMapParameters parameters;
    parameters.kernel_length = 0.1 + 0.1 * static_cast<double>(seed);
    parameters.prior = 0.05;
    BgkOctoMapMapper mapper(input, parameters);
    const std::vector<Scan> scans{randomScan(seed, 30), randomScan(seed + 100, 20)};
    for (const Scan& scan : scans) mapper.insert(scan);
    int known = 0;
    forEachCenter(1.5, [&](const Eigen::Vector3d& center) {
      NaiveCounts counts;
      for (const Scan& scan : scans)
        counts.add(scan, center, parameters.kernel_length, input.free_space.resolution);
      const VoxelEstimate voxel = mapper.at(center);
      expectPlainEstimate(voxel);
      const double mass = counts.occupied + counts.free;
      if (mass > 1e-6) {
        EXPECT_TRUE(voxel.known);
        EXPECT_NEAR(voxel.occupancy, (0.05 + counts.occupied) / (0.1 + mass), 1e-4);
        ++known;
      }
      EXPECT_TRUE(counts.nearest < 1 || !voxel.known);
    });
    EXPECT_GT(known, 3000);
  }
}

TEST(BgkOctoMapMapper, AHitIsOccupiedItsBeamFreeAndTheRestUnknown) {
  BgkOctoMapMapper mapper(baselineInput(FreeSpace::Sampled));
  mapper.insert(scanOf({2.05F, 0.05F, 0.05F}));
  EXPECT_EQ(mapper.at({2.05, 0.05, 0.05}).class_id, 1);
  EXPECT_GT(mapper.at({2.05, 0.05, 0.05}).occupancy, 0.99);
  EXPECT_TRUE(mapper.at({1.05, 0.05, 0.05}).known);
  EXPECT_LT(mapper.at({1.05, 0.05, 0.05}).occupancy, 0.01);
  EXPECT_FALSE(mapper.at({1.05, 0.55, 0.05}).known);
  EXPECT_FALSE(mapper.at({2.45, 0.05, 0.05}).known);
}

TEST(BgkOctoMapMapper, WithoutFreeSpaceHitsAreAllThatIsKnown) {
  BgkOctoMapMapper mapper(baselineInput(FreeSpace::None));
  mapper.insert(scanOf({2.05F, 0.05F, 0.05F}));
  EXPECT_EQ(mapper.at({2.05, 0.05, 0.05}).class_id, 1);
  EXPECT_FALSE(mapper.at({1.05, 0.05, 0.05}).known);
}

TEST(BgkOctoMapMapper, APointOfClassFreeIsFree) {
  BgkOctoMapMapper mapper(baselineInput(FreeSpace::None));
  mapper.insert(scanOf({2.05F, 0.05F, 0.05F}, kFreeClass));
  EXPECT_LT(mapper.at({2.05, 0.05, 0.05}).occupancy, 0.01);
}

TEST(BgkOctoMapMapper, TheOrderOfScansDoesNotMatter) {
  BgkOctoMapMapper forward(baselineInput(FreeSpace::Sampled));
  BgkOctoMapMapper backward(baselineInput(FreeSpace::Sampled));
  for (std::uint64_t seed = 0; seed < 4; ++seed) {
    forward.insert(randomScan(seed, 20));
    backward.insert(randomScan(3 - seed, 20));
  }
  forEachCenter(1.2, [&](const Eigen::Vector3d& center) {
    EXPECT_EQ(forward.at(center).known, backward.at(center).known);
    EXPECT_NEAR(forward.at(center).occupancy, backward.at(center).occupancy, 1e-9);
  });
}

TEST(BgkOctoMapMapper, DownSamplesItsInput) {
  // Two points of one cell count as one: more evidence would outweigh the prior further.
  Options input = baselineInput(FreeSpace::None);
  BgkOctoMapParameters parameters;
  parameters.prior = 1;
  input.scan.ds_resolution = 0.1;
  BgkOctoMapMapper mapper(input, parameters);
  Scan scan = scanOf({0.04F, 0.05F, 0.05F});
  scan.points.push_back({0.06F, 0.05F, 0.05F});
  scan.labels.push_back(2);
  mapper.insert(scan);
  EXPECT_NEAR(mapper.at({0.05, 0.05, 0.05}).occupancy, 2.0 / 3.0, 1e-6);
}

TEST(BgkOctoMapMapper, RejectsWhatCannotBe) {
  const Options input = baselineInput(FreeSpace::Sampled);
  BgkOctoMapParameters parameters;
  parameters.kernel_length = -1;
  EXPECT_THROW(BgkOctoMapMapper(input, parameters), OptionError);
  parameters = {};
  parameters.prior = 0;
  EXPECT_THROW(BgkOctoMapMapper(input, parameters), OptionError);
  BgkOctoMapMapper mapper(input);
  Scan scan = scanOf({1, 0, 0});
  scan.labels.clear();
  EXPECT_THROW(mapper.insert(scan), std::invalid_argument);
  scan.scores = {0.2F, 0.2F, 0.2F, 0.2F, 0.2F};
  EXPECT_THROW(mapper.insert(scan), std::invalid_argument);
}

}  // namespace
}  // namespace csom
