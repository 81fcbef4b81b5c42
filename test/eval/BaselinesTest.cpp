// SPDX-License-Identifier: BSD-3-Clause
#include <csom/eval/Baselines.h>
#include <gtest/gtest.h>

#include "BaselineScans.h"

namespace csom {
namespace {

using namespace test;

TEST(Baselines, HaveNames) {
  for (const Baseline baseline : kBaselines) EXPECT_EQ(baselineNamed(toString(baseline)), baseline);
  EXPECT_EQ(baselineNamed("bgkoctomap-l"), Baseline::BgkOctoMapL);
  EXPECT_FALSE(baselineNamed("see-csom"));
  EXPECT_FALSE(baselineNamed(""));
}

class EachBaseline : public testing::TestWithParam<Baseline> {
 protected:
  std::unique_ptr<Mapper> make(FreeSpace free_space) const {
    BaselineOptions options;
    options.input = baselineInput(free_space);
    return makeBaseline(GetParam(), options);
  }
};

TEST_P(EachBaseline, KnowsNothingBeforeTheFirstScan) {
  const auto map = make(FreeSpace::Sampled);
  EXPECT_FALSE(map->hasClasses());
  expectPlainEstimate(map->at({0.05, 0.05, 0.05}));
  EXPECT_FALSE(map->at({0.05, 0.05, 0.05}).known);
  map->insert({});
  EXPECT_FALSE(map->at({0.05, 0.05, 0.05}).known);
}

TEST_P(EachBaseline, TellsWallFromAir) {
  // A wall at x = 2, seen three times from in front of it.
  Scan scan;
  for (int y = -8; y < 8; ++y)
    for (int z = -8; z < 8; ++z) {
      scan.points.emplace_back(2.05F, 0.1F * static_cast<float>(y) + 0.05F,
                               0.1F * static_cast<float>(z) + 0.05F);
      scan.labels.push_back(3);
    }
  const auto map = make(FreeSpace::Sampled);
  for (int n = 0; n < 3; ++n) map->insert(scan);
  for (const double y : {-0.55, 0.05, 0.55}) {
    EXPECT_EQ(map->at({2.05, y, 0.05}).class_id, 1) << y;
    EXPECT_GT(map->at({2.05, y, 0.05}).occupancy, 0.7) << y;
  }
  for (const double x : {0.85, 1.15, 1.45}) {
    EXPECT_TRUE(map->at({x, 0.05, 0.05}).known) << x;
    EXPECT_LT(map->at({x, 0.05, 0.05}).occupancy, 0.3) << x;
  }
  EXPECT_FALSE(map->at({4.05, 0.05, 0.05}).known);
}

TEST_P(EachBaseline, GivesTheSameBitsForTheSameInput) {
  const auto one = make(FreeSpace::Sampled);
  const auto two = make(FreeSpace::Sampled);
  for (const std::uint64_t seed : {1, 2}) {
    one->insert(randomScan(seed, 40));
    two->insert(randomScan(seed, 40));
  }
  forEachCenter(1.2, [&](const Eigen::Vector3d& center) {
    EXPECT_EQ(one->at(center).occupancy, two->at(center).occupancy);
  });
}

TEST_P(EachBaseline, CountsOnlyPointsThatTheLibraryAccepts) {
  const auto map = make(FreeSpace::Sampled);
  Scan scan = scanOf({1, 0, 0}, 7);  // five classes
  scan.points.emplace_back(NAN, 0.0F, 0.0F);
  scan.labels.push_back(1);
  map->insert(scan);
  EXPECT_FALSE(map->at({1.05, 0.05, 0.05}).known);
}

TEST_P(EachBaseline, RejectsLabelsThatDoNotFitThePoints) {
  const auto map = make(FreeSpace::Sampled);
  Scan scan = scanOf({1, 0, 0});
  scan.labels.push_back(1);
  EXPECT_THROW(map->insert(scan), std::invalid_argument);
  scan.labels.clear();
  scan.scores = {0, 1, 0, 0, 0};
  EXPECT_THROW(map->insert(scan), std::invalid_argument);
}

TEST_P(EachBaseline, RejectsInvalidInputOptions) {
  BaselineOptions options;
  options.input.resolution = -1;
  EXPECT_THROW(makeBaseline(GetParam(), options), OptionError);
}

INSTANTIATE_TEST_SUITE_P(, EachBaseline, testing::ValuesIn(kBaselines),
                         [](const testing::TestParamInfo<Baseline>& method) {
                           std::string name = toString(method.param);
                           for (char& letter : name)
                             if (letter == '-') letter = '_';
                           return name;
                         });

}  // namespace
}  // namespace csom
