// SPDX-License-Identifier: BSD-3-Clause
// Many threads ask one map for likelihoods while its distance field is being made. Compiled with
// ThreadSanitizer, which ends the program at a race.
#include <csom/maps/ObservationLikelihood.h>
#include <gtest/gtest.h>

#include <random>
#include <thread>
#include <vector>

namespace csom {
namespace {

/// A wall of 16 x 4 m at y = 3.1, in stripes of two classes.
Scan stripedWall() {
  Scan scan;
  for (float x = -8; x < 8; x += 0.1f)
    for (float z = -2; z < 2; z += 0.1f) {
      scan.points.emplace_back(x, 3.1f, z);
      scan.labels.push_back(x < 0 ? 1 : 2);
    }
  return scan;
}

TEST(LikelihoodThreads, AgreeOnAMapThatNoneHasAskedYet) {
  Options options;
  options.number_of_classes = 3;
  SemanticMap map(options);
  map.insert(stripedWall());
  std::vector<Eigen::Vector3d> points;
  std::vector<ClassId> labels;
  for (double x = -6; x < 6; x += 0.25) {
    points.emplace_back(x, 3.1, 0.1);
    labels.push_back(x < 0 ? 1 : 2);
  }
  LikelihoodOptions likelihood;
  likelihood.semantic_weight = 1;
  for (const LikelihoodMethod method : {LikelihoodMethod::Field, LikelihoodMethod::Beam}) {
    likelihood.method = method;
    const NearestVoxelField field;
    std::vector<std::vector<double>> values(8);
    std::vector<std::thread> threads;
    for (std::vector<double>& mine : values) {
      threads.emplace_back([&] {
        for (int step = 0; step < 30; ++step) {
          Eigen::Isometry3d sensor = Eigen::Isometry3d::Identity();
          sensor.translation() << 0.3 * step, 0.05 * step, 0;
          mine.push_back(logLikelihood(map, field, likelihood, points, labels, sensor));
        }
      });
    }
    for (std::thread& thread : threads) thread.join();
    for (const std::vector<double>& mine : values) EXPECT_EQ(mine, values.front());
    EXPECT_GT(values.front().front(), values.front().back() + 1);
  }
}

}  // namespace
}  // namespace csom
