// SPDX-License-Identifier: BSD-3-Clause
// Many threads ask one map for the likelihood of one observation, through MRPT's door. All that the
// project has on that way is compiled with ThreadSanitizer, which ends the program at a race;
// MRPT's own libraries are not.
#include <csom/maps/CSemanticContinuousMap.h>
#include <gtest/gtest.h>

#include <thread>
#include <vector>

#include "SampleObservations.h"

namespace csom {
namespace {

using mrpt::poses::CPose3D;

TEST(MapLikelihoodThreads, AgreeOnAMapThatNoneHasAskedYet) {
  const auto observation = sample::roomCloud();
  std::vector<CPose3D> poses;
  for (int i = 0; i < 16; ++i) poses.emplace_back(0.2 * i, 0.1 * i, 0, 0.02 * i, 0, 0);
  for (const LikelihoodMethod method : {LikelihoodMethod::Field, LikelihoodMethod::Beam}) {
    CSemanticContinuousMap map = sample::roomMap();
    map.likelihoodOptions.method = method;
    map.likelihoodOptions.semantic_weight = 1;
    const CSemanticContinuousMap& asked = map;
    std::vector<std::vector<double>> values(8);
    std::vector<std::thread> threads;
    for (std::vector<double>& mine : values) {
      threads.emplace_back([&] {
        for (const CPose3D& pose : poses) {
          // MRPT's poses remember their angles when they are asked for: one for each thread.
          const CPose3D own(pose.x(), pose.y(), pose.z(), 0.1 * pose.x(), 0, 0);
          EXPECT_TRUE(asked.canComputeObservationLikelihood(*observation));
          mine.push_back(asked.computeObservationLikelihood(*observation, own));
        }
      });
    }
    for (std::thread& thread : threads) thread.join();
    for (const std::vector<double>& mine : values) EXPECT_EQ(mine, values.front());
    EXPECT_GT(values.front().front(), values.front().back());
  }
}

}  // namespace
}  // namespace csom
