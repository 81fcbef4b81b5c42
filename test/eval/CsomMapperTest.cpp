// SPDX-License-Identifier: BSD-3-Clause
#include <csom/eval/CsomMapper.h>
#include <gtest/gtest.h>

namespace csom {
namespace {

Options voxelsOfTheirOwn() {
  Options options;
  options.number_of_classes = 4;
  options.resolution = 0.5;
  options.method = Method::SCsm;
  options.prior = 0.25;
  return options;
}

Scan pointOf(ClassId label) {
  Scan scan;
  scan.points = {{1.2F, 0.1F, 0.1F}};
  scan.labels = {label};
  return scan;
}

TEST(CsomMapper, ReportsTheMapsProbabilities) {
  CsomMapper mapper(voxelsOfTheirOwn());
  mapper.insert(pointOf(2));
  const VoxelEstimate voxel = mapper.at({1.25, 0.25, 0.25});
  EXPECT_TRUE(voxel.known);
  EXPECT_EQ(voxel.class_id, 2);
  EXPECT_EQ(voxel.probabilities, (std::vector<double>{0.125, 0.125, 0.625, 0.125}));
  EXPECT_EQ(voxel.occupancy, 0.875);
}

TEST(CsomMapper, AFreeVoxelIsKnownAndOfNoOtherClass) {
  CsomMapper mapper(voxelsOfTheirOwn());
  mapper.insert(pointOf(kFreeClass));
  const VoxelEstimate voxel = mapper.at({1.25, 0.25, 0.25});
  EXPECT_TRUE(voxel.known);
  EXPECT_EQ(voxel.class_id, kFreeClass);
  EXPECT_EQ(voxel.occupancy, 0.375);
}

TEST(CsomMapper, WhatWasNeverSeenIsUnknown) {
  CsomMapper mapper(voxelsOfTheirOwn());
  mapper.insert(pointOf(2));
  EXPECT_FALSE(mapper.at({5.25, 0.25, 0.25}).known);
  EXPECT_FALSE(mapper.at({1e12, 0, 0}).known);  // beyond the addressable range
}

}  // namespace
}  // namespace csom
