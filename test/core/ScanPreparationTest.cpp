// SPDX-License-Identifier: BSD-3-Clause
// What is rejected, and how points are thinned out and binned.
#include <csom/core/ContextEntropy.h>
#include <csom/core/ScanPreparation.h>
#include <gtest/gtest.h>

#include <limits>

namespace csom {
namespace {

std::size_t rejected(const ScanReport& report, RejectReason reason) {
  return report.rejected[static_cast<std::size_t>(reason)];
}

Options smallOptions() {
  Options options;
  options.number_of_classes = 3;
  options.resolution = 0.5;
  return options;
}

TEST(ScanPreparation, EveryReasonIsCounted) {
  constexpr float nan = std::numeric_limits<float>::quiet_NaN();
  constexpr float inf = std::numeric_limits<float>::infinity();
  Options options = smallOptions();
  options.scan.min_range = 1;
  options.scan.max_range = 1e6;
  Scan scan;
  scan.points = {{2, 0, 0},    {nan, 0, 0},  {0, inf, 0},  {0, 0, -inf},
                 {0.5F, 0, 0}, {9e5F, 0, 0}, {2e6F, 0, 0}, {3, 0, 0}};
  scan.labels = {1, 1, 1, 1, 1, 1, 1, 3};
  ScanReport report;
  const PreparedScan prepared = prepareScan(scan, options, report);
  EXPECT_EQ(report.points, 8U);
  EXPECT_EQ(rejected(report, RejectReason::NonFinite), 3U);
  EXPECT_EQ(rejected(report, RejectReason::TooNear), 1U);
  EXPECT_EQ(rejected(report, RejectReason::TooFar), 1U);
  EXPECT_EQ(rejected(report, RejectReason::OutsideIndexRange), 1U);
  EXPECT_EQ(rejected(report, RejectReason::ClassOutOfRange), 1U);
  EXPECT_EQ(report.rejectedTotal() + report.training_points, report.points);
  ASSERT_EQ(prepared.points.size(), 1U);
}

TEST(ScanPreparation, AnOriginThatIsNoPlaceRejectsEveryPoint) {
  Scan scan;
  scan.points = {{1, 0, 0}, {2, 0, 0}};
  scan.labels = {1, 1};
  scan.origin = {std::numeric_limits<double>::quiet_NaN(), 0, 0};
  ScanReport report;
  EXPECT_TRUE(prepareScan(scan, smallOptions(), report).points.empty());
  EXPECT_EQ(rejected(report, RejectReason::NonFinite), 2U);
  scan.origin = {1e300, 0, 0};
  ScanReport far;
  prepareScan(scan, smallOptions(), far);
  EXPECT_EQ(rejected(far, RejectReason::OutsideIndexRange), 2U);
}

TEST(ScanPreparation, ScoresMustBeADistribution) {
  Scan scan;
  scan.points.assign(5, {1, 1, 1});
  scan.scores = {0.2F,
                 0.3F,
                 0.5F,
                 /**/ 0.2F,
                 0.3F,
                 0.6F,
                 /**/ -0.5F,
                 1,
                 0.5F,
                 /**/ 1,
                 0,
                 0.0005F, /**/
                 std::numeric_limits<float>::quiet_NaN(),
                 0,
                 1};
  ScanReport report;
  const PreparedScan prepared = prepareScan(scan, smallOptions(), report);
  EXPECT_EQ(rejected(report, RejectReason::InvalidScores), 3U);
  EXPECT_EQ(prepared.points.size(), 2U);
  EXPECT_EQ(prepared.scores.size(), 6U);
}

TEST(ScanPreparation, SizesThatDoNotMatchThrow) {
  ScanReport report;
  Scan scan;
  scan.points.assign(2, {1, 1, 1});
  scan.labels = {1};
  EXPECT_THROW(prepareScan(scan, smallOptions(), report), std::invalid_argument);
  scan.labels = {1, 1};
  scan.scores.assign(6, 1.0F / 3);
  EXPECT_THROW(prepareScan(scan, smallOptions(), report), std::invalid_argument);
  scan.labels.clear();
  scan.scores.pop_back();
  EXPECT_THROW(prepareScan(scan, smallOptions(), report), std::invalid_argument);
}

TEST(ScanPreparation, AnImageMustFitItsScan) {
  const auto messageOf = [](const Scan& scan) -> std::string {
    ScanReport report;
    try {
      prepareScan(scan, Options{}, report);
    } catch (const std::invalid_argument& error) {
      return error.what();
    }
    return "";
  };
  Scan scan;
  scan.points.assign(3, {1, 2, 3});
  scan.labels.assign(3, 1);
  scan.image.pixels.assign(3, {0, 5});
  EXPECT_EQ(messageOf(scan), "");
  scan.image.columns_of_turn = 5;
  EXPECT_EQ(messageOf(scan), "image of a scan: point 0 has column 5; a turn has columns 0 to 4");
  scan.image.pixels.assign(3, {RangeImage::kNoRow, 5});
  EXPECT_EQ(messageOf(scan), "");
  scan.image.column_step = 0;
  EXPECT_EQ(messageOf(scan),
            "image of a scan: column_step is 0 and columns_of_turn 5; they are at least 1 and at "
            "least 0");
  scan.image.column_step = 1;
  scan.image.pixels.resize(2);
  EXPECT_EQ(messageOf(scan), "scan of 3 points has an image of 2");
}

TEST(ScanPreparation, RejectedPointsLeaveTheImage) {
  Scan scan;
  for (int i = 0; i < 6; ++i) {
    scan.points.emplace_back(i % 2 == 0 ? 1.0F + static_cast<float>(i) : std::nanf(""), 0, 0);
    scan.labels.push_back(1);
    scan.image.pixels.push_back({static_cast<std::uint16_t>(i), 10 * i});
  }
  ScanReport report;
  const PreparedScan prepared = prepareScan(scan, Options{}, report);
  EXPECT_EQ(report.rejectedTotal(), 3U);
  EXPECT_EQ(report.training_points, 3U);
  ASSERT_EQ(prepared.image_points.points.size(), 3U);
  ASSERT_EQ(prepared.image_points.image.pixels.size(), 3U);
  for (std::uint16_t i = 0; i < 3; ++i) {
    EXPECT_EQ(prepared.image_points.points[i].x(), 1.0F + 2.0F * i);
    EXPECT_EQ(prepared.image_points.image.pixels[i],
              (RangeImage::Pixel{static_cast<std::uint16_t>(2 * i), 20 * i}));
  }
  EXPECT_TRUE(prepared.points.empty());
}

TEST(ScanPreparation, OnlySurfaceCsomLooksAtTheImage) {
  Scan scan;
  scan.points.assign(3, {1, 2, 3});
  scan.labels.assign(3, 1);
  scan.image.pixels.assign(3, {0, 5});
  Options options;
  ScanReport report;
  EXPECT_FALSE(prepareScan(scan, options, report).image_points.points.empty());
  options.free_space.mode = FreeSpace::Sampled;
  EXPECT_TRUE(prepareScan(scan, options, report).image_points.points.empty());
  options.free_space.mode = FreeSpace::Projective;
  for (const Method method : {Method::SeeCsom, Method::SBki, Method::SCsm}) {
    options.method = method;
    const PreparedScan prepared = prepareScan(scan, options, report);
    EXPECT_TRUE(prepared.image_points.points.empty());
    EXPECT_EQ(prepared.beam_ends.size(), 3U) << "as raycast";
  }
}

TEST(ScanPreparation, DownSamplingTakesCentroidAndMajority) {
  Options options = smallOptions();
  options.scan.ds_resolution = 1.0;
  options.resolution = 4.0;
  Scan scan;
  scan.points = {{0.2F, 0.2F, 0.2F},
                 {0.4F, 0.2F, 0.2F},
                 {0.6F, 0.2F, 0.2F},
                 {-0.2F, 0.2F, 0.2F},
                 {-0.4F, 0.2F, 0.2F}};
  scan.labels = {1, 2, 2, 2, 1};
  ScanReport report;
  const PreparedScan prepared = prepareScan(scan, options, report);
  EXPECT_EQ(report.training_points, 2U);
  ASSERT_EQ(prepared.blocks.size(), 2U);  // blocks of 8 m: x in [−8,0) and [0,8)
  EXPECT_EQ(prepared.blocks[0], (BlockIndex{-1, 0, 0}));
  EXPECT_NEAR(prepared.points[0].x, 7.7 / 4,
              1e-5);  // voxels of 4 m: −0.3 m from its block's corner
  EXPECT_EQ(prepared.points[0].label, 1) << "a tie goes to the lower class";
  EXPECT_NEAR(prepared.points[1].x, 0.4 / 4, 1e-5);
  EXPECT_EQ(prepared.points[1].label, 2);
}

TEST(ScanPreparation, FreeSamplesEndOneStepBeforeTheHit) {
  Options options = smallOptions();
  options.free_space.mode = FreeSpace::Sampled;
  options.free_space.resolution = 0.5;
  options.block_depth = 1;
  Scan scan;
  scan.origin = {0, 0.25, 0.25};
  scan.points = {{1.75F, 0, 0}};
  scan.labels = {2};
  ScanReport report;
  const PreparedScan prepared = prepareScan(scan, options, report);
  EXPECT_EQ(report.free_points, 3U);  // at 1.25, 0.75 and 0.25 m
  ASSERT_EQ(prepared.points.size(), 4U);
  for (std::size_t i = 0; i < 4; ++i) {
    EXPECT_EQ(prepared.blocks[i], (BlockIndex{static_cast<std::int32_t>(i), 0, 0}));
    EXPECT_EQ(prepared.points[i].label, i == 3 ? 2 : kFreeClass);
    EXPECT_NEAR(prepared.points[i].x, 0.5, 1e-5);
  }
}

TEST(ScanPreparation, StrayPointsFarAwayCostNoFreeSpace) {
  for (const FreeSpace kind : {FreeSpace::Sampled, FreeSpace::Raycast}) {
    Options options = smallOptions();
    options.free_space.mode = kind;
    options.free_space.resolution = 0.5;
    Scan scan;
    scan.points = {{90000, 0, 0}, {4000, 0, 0}};  // 180,000 and 8,000 steps
    scan.labels = {1, 1};
    ScanReport report;
    prepareScan(scan, options, report);
    EXPECT_EQ(rejected(report, RejectReason::BeamTooLong), 1U);
    EXPECT_EQ(report.training_points, 1U);
  }
}

TEST(ScanPreparation, MoreFreeSamplesThanMemoryAreRefused) {
  Options options = smallOptions();
  options.free_space.mode = FreeSpace::Sampled;
  options.free_space.resolution = 0.5;
  Scan scan;
  scan.points.assign(20000, {4000, 0, 0});
  scan.labels.assign(20000, 1);
  ScanReport report;
  EXPECT_THROW(prepareScan(scan, options, report), std::invalid_argument);
}

TEST(ScanPreparation, AScanMayReachToItsLimitOnEveryAxis) {
  // The widest scan that is accepted: its keys must not overflow, its blocks stay in order.
  Options options;
  options.method = Method::SeeCsom;
  options.resolution = 0.25;
  options.block_depth = 1;
  Scan scan;
  const float end = 0.25F * ((1 << 20) - 5);
  for (const float x : {-end, end})
    for (const float y : {-end, end})
      for (const float z : {-end, end}) scan.points.emplace_back(x, y, z);
  scan.points.emplace_back(end * 1.001F, 0.0F, 0.0F);
  scan.labels.assign(scan.points.size(), 1);
  ScanReport report;
  const PreparedScan prepared = prepareScan(scan, options, report);
  EXPECT_EQ(rejected(report, RejectReason::OutsideIndexRange), 1U);
  ASSERT_EQ(prepared.blocks.size(), 8U);
  for (std::size_t b = 0; b + 1 < prepared.blocks.size(); ++b)
    EXPECT_TRUE(prepared.blocks[b] < prepared.blocks[b + 1]);
  EXPECT_EQ(prepared.blocks.front(), (BlockIndex{-(1 << 20) + 5, -(1 << 20) + 5, -(1 << 20) + 5}));
  EXPECT_EQ(filledBlocks(prepared.blocks, options).size(), 8U);
}

TEST(ScanPreparation, LargeScansAreGroupedLikeSmallOnes) {
  // 20,000 points take the radix sort, a handful std::stable_sort: the cells must be the same.
  Options options = smallOptions();
  options.scan.ds_resolution = 0.25;
  Scan scan;
  std::uint32_t state = 1;
  const auto next = [&state] {
    state = state * 1664525U + 1013904223U;
    return static_cast<float>(state >> 8U) / static_cast<float>(1U << 24U) * 40.0F - 20.0F;
  };
  for (int i = 0; i < 20000; ++i) {
    scan.points.emplace_back(next(), next(), next() / 20);
    scan.labels.push_back(1);
  }
  ScanReport report;
  const PreparedScan prepared = prepareScan(scan, options, report);
  ASSERT_EQ(prepared.block_begin.size(), prepared.blocks.size() + 1);
  EXPECT_EQ(prepared.block_begin.back(), prepared.points.size());
  for (std::size_t b = 0; b + 1 < prepared.blocks.size(); ++b)
    ASSERT_TRUE(prepared.blocks[b] < prepared.blocks[b + 1]);
  for (const TrainingPoint& p : prepared.points) {
    for (const float c : {p.x, p.y, p.z}) ASSERT_TRUE(c >= 0.0F && c <= 2.0F);
  }
}

}  // namespace
}  // namespace csom
