// SPDX-License-Identifier: BSD-3-Clause
// Of the same observations the semantic map and MRPT's COctoMap give the same answers, as far as
// both give any.
#include <csom/maps/CSemanticContinuousMap.h>
#include <gtest/gtest.h>
#include <mrpt/maps/COctoMap.h>
#include <mrpt/obs/stock_observations.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <random>

#include "SampleObservations.h"

namespace csom {
namespace {

using mrpt::maps::COctoMap;
using mrpt::poses::CPose3D;

constexpr double kResolution = 0.1;

/// Both maps, filled with the same observations.
class OctoMapAgreement : public testing::Test {
 protected:
  OctoMapAgreement() : octo_(kResolution), semantic_(options()) {}

  void insert(const mrpt::obs::CObservation& observation, const CPose3D& pose = CPose3D()) {
    ASSERT_TRUE(octo_.insertObservation(observation, pose));
    ASSERT_TRUE(semantic_.insertObservation(observation, pose));
  }

  /// A real room, seen by a laser scanner.
  static mrpt::obs::CObservation2DRangeScan stockScan() {
    mrpt::obs::CObservation2DRangeScan scan;
    mrpt::obs::stock_observations::example2DRangeScan(scan);
    return scan;
  }

  /// The walls of a room of 6 x 4 x 2 m, seen by a camera at its middle.
  void insertRoom() {
    const auto scan = sample::velodyneRoom();
    insert(*scan, CPose3D(0.013, -0.017, 0.019, 0.3, 0, 0));
  }

  double occupancyOf(const Eigen::Vector3d& at) const {
    double occupancy = 0.5;
    octo_.getPointOccupancy(static_cast<float>(at.x()), static_cast<float>(at.y()),
                            static_cast<float>(at.z()), occupancy);
    return occupancy;
  }

  COctoMap octo_;
  CSemanticContinuousMap semantic_;

 private:
  /// As OctoMap counts: points in voxels, and voxels that beams cross.
  static Options options() {
    Options options;
    options.resolution = kResolution;
    options.method = Method::SCsm;
    options.free_space.mode = FreeSpace::Raycast;
    return options;
  }
};

/// A COctoMap of MRPT 2.5.8 that holds nothing does not say so; what it says with something in it
/// is right.
TEST_F(OctoMapAgreement, OnNotBeingEmpty) {
  EXPECT_TRUE(semantic_.isEmpty());
  insert(stockScan());
  EXPECT_FALSE(octo_.isEmpty());
  EXPECT_FALSE(semantic_.isEmpty());
  semantic_.clear();
  EXPECT_TRUE(semantic_.isEmpty());
}

TEST_F(OctoMapAgreement, OnWhatIsOccupiedAndFree) {
  insert(stockScan());
  std::size_t occupied = 0;
  std::size_t free_count = 0;
  std::size_t disagreements = 0;
  semantic_.map().forEachVoxel([&](const VoxelIndex& index, const DirichletVoxel& voxel) {
    const bool is_occupied = voxel.state() == VoxelState::Occupied;
    ++(is_occupied ? occupied : free_count);
    const double theirs = occupancyOf(semantic_.map().grid().center(index));
    if (is_occupied ? theirs <= 0.5 : theirs >= 0.5) ++disagreements;
  });
  EXPECT_GT(occupied, 50u);
  EXPECT_GT(free_count, 1000u);
  // Beams that graze a voxel's edge are counted for it or for its neighbour.
  EXPECT_LE(disagreements, (occupied + free_count) / 20);
}

TEST_F(OctoMapAgreement, OnTheBoundingBox) {
  insertRoom();
  const auto ours = semantic_.boundingBox();
  std::array<double, 3> min{};
  std::array<double, 3> max{};
  octo_.getMetricMin(min[0], min[1], min[2]);
  octo_.getMetricMax(max[0], max[1], max[2]);
  for (int axis = 0; axis < 3; ++axis) {
    const auto k = static_cast<std::size_t>(axis);
    EXPECT_NEAR(ours.min[k], min[k], kResolution * 1.01) << "axis " << axis;
    EXPECT_NEAR(ours.max[k], max[k], kResolution * 1.01) << "axis " << axis;
  }
}

TEST_F(OctoMapAgreement, OnWhereRaysEnd) {
  insertRoom();
  std::mt19937_64 random(7);
  std::uniform_real_distribution<double> angle(-M_PI, M_PI);
  std::uniform_real_distribution<double> rise(-0.2, 0.2);
  int hits = 0;
  int misses = 0;
  int disagreements = 0;
  const Eigen::Vector3d from(0.05, 0.05, 0.05);
  for (int i = 0; i < 300; ++i) {
    const double a = angle(random);
    const Eigen::Vector3d direction(std::cos(a), std::sin(a), rise(random));
    // Some too short for the walls.
    const double longest = i % 3 == 0 ? 1.5 : 10;
    mrpt::math::TPoint3D end;
    const bool theirs =
        octo_.castRay({from.x(), from.y(), from.z()}, {direction.x(), direction.y(), direction.z()},
                      end, true, longest);
    const auto ours = semantic_.map().castRay(from, direction, longest);
    if (theirs && ours) {
      ++hits;
      const Eigen::Vector3d apart =
          semantic_.map().grid().center(ours->voxel) - Eigen::Vector3d(end.x, end.y, end.z);
      if (apart.norm() > 2 * kResolution) ++disagreements;
    } else if (!theirs && !ours) {
      ++misses;
    } else {
      ++disagreements;
    }
  }
  EXPECT_GT(hits, 100);
  EXPECT_GT(misses, 50);
  EXPECT_LE(disagreements, 15) << "of 300";
}

/// Poses that differ clearly are in the same order for both. What is unknown to it does not count
/// for COctoMap: rays are left out that end in unknown space from any of the poses.
TEST_F(OctoMapAgreement, OnWhichPoseFitsBetter) {
  insert(stockScan());
  auto scan = stockScan();  // MRPT remembers the points of a scan that has been inserted
  std::vector<CPose3D> poses;
  for (const double back : {0.0, 0.15, 0.3, 0.6})
    for (const double turn : {0.0, 0.02, 0.1}) poses.emplace_back(-back, 0, 0, turn, 0, 0);
  std::size_t rays = 0;
  for (std::size_t i = 0; i < scan.getScanSize(); ++i) {
    const double share = static_cast<double>(i) / static_cast<double>(scan.getScanSize() - 1);
    const double angle = (share - 0.5) * static_cast<double>(scan.aperture);
    const double range = static_cast<double>(scan.getScanRange(i));
    const mrpt::math::TPoint3D end(range * std::cos(angle), range * std::sin(angle), 0);
    for (const CPose3D& pose : poses) {
      const auto at = (pose + scan.sensorPose).composePoint(end);
      double occupancy = 0;
      if (!octo_.getPointOccupancy(static_cast<float>(at.x), static_cast<float>(at.y),
                                   static_cast<float>(at.z), occupancy))
        scan.setScanRangeValidity(i, false);
    }
    if (scan.getScanRangeValidity(i)) ++rays;
  }
  ASSERT_GT(rays, 20u);
  octo_.likelihoodOptions.decimation = 1;
  semantic_.likelihoodOptions.decimation = 1;
  semantic_.likelihoodOptions.max_distance = 0.3;
  semantic_.likelihoodOptions.sigma = 0.1;
  std::vector<double> theirs;
  std::vector<double> ours;
  for (const CPose3D& pose : poses) {
    theirs.push_back(octo_.computeObservationLikelihood(scan, pose));
    ours.push_back(semantic_.computeObservationLikelihood(scan, pose));
  }
  const double range = *std::max_element(theirs.begin(), theirs.end()) -
                       *std::min_element(theirs.begin(), theirs.end());
  int clear = 0;
  int agreed = 0;
  for (std::size_t i = 0; i < poses.size(); ++i)
    for (std::size_t k = 0; k < poses.size(); ++k) {
      if (theirs[i] < theirs[k] + 0.1 * range) continue;
      ++clear;
      if (ours[i] > ours[k]) ++agreed;
    }
  EXPECT_EQ(std::max_element(theirs.begin(), theirs.end()) - theirs.begin(), 0) << "the true pose";
  EXPECT_EQ(std::max_element(ours.begin(), ours.end()) - ours.begin(), 0);
  EXPECT_GT(clear, 20);
  EXPECT_GE(agreed, clear * 9 / 10) << "of " << clear;
}

}  // namespace
}  // namespace csom
