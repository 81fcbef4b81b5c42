// SPDX-License-Identifier: BSD-3-Clause
#include <csom/protocols/LabelledCloud.h>
#include <gmock/gmock.h>

#include <stdexcept>

namespace csom {
namespace {

using testing::ElementsAre;

LabelledCloud example() {
  LabelledCloud cloud;
  cloud.add({0.2, 0.2, 0.2}, 2);
  cloud.add({0.3, 0.2, 0.2}, 1);
  cloud.add({0.4, 0.2, 0.2}, 2);
  cloud.add({1.5, 0.2, 0.2}, kFreeClass);  // no label, alone in its voxel
  cloud.add({0.4, 0.4, 0.2}, kFreeClass);  // no label, beside others
  cloud.add({2.5, 0.2, 0.2}, 3);
  cloud.add({2.6, 0.2, 0.2}, 1);
  return cloud;
}

TEST(LabelledCloud, AScanHoldsThePointsWithALabelAsSeenFromItsOrigin) {
  const Scan scan = scanOf(example(), {0, 0, 1});
  EXPECT_THAT(scan.labels, ElementsAre(2, 1, 2, 3, 1));
  EXPECT_EQ(scan.origin, Eigen::Vector3d(0, 0, 1));
  EXPECT_TRUE(scan.points[3].isApprox(Eigen::Vector3f(2.5f, 0.2f, -0.8f)));
}

TEST(LabelledCloud, TruthIsTheMajorityAndLeavesOutWhatHasNoLabel) {
  const VoxelTruth truth = computeTruth(example(), 1.0, 4);
  EXPECT_EQ(truth.at({0, 0, 0}), 2);
  EXPECT_FALSE(truth.at({1, 0, 0}));
  EXPECT_EQ(truth.at({2, 0, 0}), 1);  // a tie: the lower id
  EXPECT_EQ(truth.at({2, 1, 0}), kFreeClass);
  EXPECT_FALSE(truth.knowsFree());
}

TEST(LabelledCloud, WithoutALabelThereIsNoTruth) {
  LabelledCloud cloud;
  cloud.add({0, 0, 0}, kFreeClass);
  EXPECT_THROW(computeTruth(cloud, 1.0, 4), std::invalid_argument);
}

}  // namespace
}  // namespace csom
