// SPDX-License-Identifier: BSD-3-Clause
// Scans that no sensor makes cost bounded time and memory.
#include <csom/core/SemanticMap.h>
#include <gtest/gtest.h>
#include <sys/resource.h>

#include <cmath>
#include <limits>
#include <random>

#include "core/RandomScans.h"
#include "util/Sanitizers.h"

namespace csom::test {
namespace {

// AddressSanitizer takes ten times as long, and keeps what was freed for a while.
#ifdef CSOM_ADDRESS_SANITIZED
constexpr std::size_t kMany = 1'000'000;
constexpr std::size_t kMaxBytes = 1000 * kMany;
#else
constexpr std::size_t kMany = 10'000'000;
constexpr std::size_t kMaxBytes = 250 * kMany;
#endif

std::size_t peakBytes() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return static_cast<std::size_t>(usage.ru_maxrss) * 1024;
}

/// One process for each of them: a peak is never forgotten.
class AbsurdScans : public testing::TestWithParam<Method> {
 protected:
  AbsurdScans() {
    options.method = GetParam();
    options.resolution = 0.2;
    options.scan.ds_resolution = 0.1;
    options.free_space.mode = FreeSpace::Raycast;
    options.scan.max_range = 60;
  }
  Options options;
};

TEST_P(AbsurdScans, TenMillionPoints) {
  std::mt19937 random(1);
  std::uniform_real_distribution<float> coordinate(-10, 10);
  Scan scan;
  scan.points.reserve(kMany);
  for (std::size_t i = 0; i < kMany; ++i)
    scan.points.emplace_back(coordinate(random), coordinate(random), 0.1F * coordinate(random));
  scan.labels.assign(kMany, 1);
  const std::size_t before = peakBytes();
  SemanticMap map(options);
  const ScanReport report = map.insert(scan);
  EXPECT_EQ(report.points, kMany);
  EXPECT_EQ(report.rejectedTotal(), 0U);
  EXPECT_LT(peakBytes() - before, kMaxBytes);
}

TEST_P(AbsurdScans, TenMillionPointsAtOnePlace) {
  for (const double cell : {0.1, 0.0}) {
    options.scan.ds_resolution = cell;
    // Without down-sampling every one of them has its kernel.
    const std::size_t points = cell > 0 ? kMany : kMany / 10;
    Scan scan;
    scan.points.assign(points, Eigen::Vector3f(3, 2, 1));
    scan.labels.assign(points, 1);
    const std::size_t before = peakBytes();
    SemanticMap map(options);
    const ScanReport report = map.insert(scan);
    EXPECT_EQ(report.rejectedTotal(), 0U);
    EXPECT_EQ(map.at({3.05, 2.05, 1.05}).mostLikelyClass(), 1);
    EXPECT_LT(peakBytes() - before, kMaxBytes);
    EXPECT_LT(map.memoryBytes(), 1'000'000U);
  }
}

TEST_P(AbsurdScans, ARangeOfABillionMetres) {
  options.scan.max_range = 0;
  for (const FreeSpace free_space : {FreeSpace::None, FreeSpace::Sampled, FreeSpace::Raycast}) {
    options.free_space.mode = free_space;
    SemanticMap map(options);
    Scan scan;
    for (const float far : {1e9F, -1e9F, 1e30F, std::numeric_limits<float>::max()})
      for (int axis = 0; axis < 3; ++axis) {
        scan.points.emplace_back(Eigen::Vector3f::Unit(axis) * far);
        scan.labels.push_back(1);
      }
    scan.points.emplace_back(2.F, 0.F, 0.F);
    scan.labels.push_back(1);
    const ScanReport report = map.insert(scan);
    EXPECT_EQ(report.rejectedTotal(), scan.points.size() - 1);
    EXPECT_EQ(map.at({2.05, 0.05, 0.05}).mostLikelyClass(), 1);
    EXPECT_LT(map.memoryBytes(), 1'000'000U);
  }
}

TEST_P(AbsurdScans, ASensorFarOutside) {
  SemanticMap map(options);
  Scan scan;
  scan.origin = {1e9, 0, 0};
  scan.points.emplace_back(2.F, 0.F, 0.F);
  scan.labels.push_back(1);
  EXPECT_EQ(map.insert(scan).rejectedTotal(), 1U);
  scan.origin = {std::nan(""), 0, 0};
  EXPECT_EQ(map.insert(scan).rejectedTotal(), 1U);
  EXPECT_TRUE(map.empty());
}

INSTANTIATE_TEST_SUITE_P(Methods, AbsurdScans,
                         testing::Values(Method::SurfaceCsom, Method::SeeCsom, Method::SBki,
                                         Method::SCsm),
                         methodName);

}  // namespace
}  // namespace csom::test
