// SPDX-License-Identifier: BSD-3-Clause
#include <csom/eval/RocCurve.h>
#include <gmock/gmock.h>

namespace csom {
namespace {

using testing::ElementsAre;
using testing::Field;
using testing::Matcher;

Matcher<RocPoint> point(double false_positive_rate, double true_positive_rate) {
  return testing::AllOf(Field(&RocPoint::false_positive_rate, false_positive_rate),
                        Field(&RocPoint::true_positive_rate, true_positive_rate));
}

TEST(RocCurve, OfScoresInAGivenOrder) {
  RocSamples samples;
  samples.add(0.4, false);
  samples.add(0.9, true);
  samples.add(0.6, true);
  samples.add(0.7, false);
  const auto curve = samples.curve(0.5);
  ASSERT_TRUE(curve);
  EXPECT_THAT(curve->points(),
              ElementsAre(point(0, 0), point(0, 0.5), point(0.5, 0.5), point(0.5, 1), point(1, 1)));
  EXPECT_DOUBLE_EQ(curve->auc(), 0.75);  // three of four pairs are in order
  EXPECT_DOUBLE_EQ(curve->truePositiveRateAt(0), 0.5);
  EXPECT_DOUBLE_EQ(curve->truePositiveRateAt(0.2), 0.5);
  EXPECT_DOUBLE_EQ(curve->truePositiveRateAt(0.5), 1);
  EXPECT_DOUBLE_EQ(curve->truePositiveRateAt(1), 1);
}

TEST(RocCurve, EqualScoresAreHalfInOrder) {
  RocSamples samples;
  for (int i = 0; i < 3; ++i) samples.add(0.5, true);
  for (int i = 0; i < 5; ++i) samples.add(0.5, false);
  const auto curve = samples.curve(0.5);
  ASSERT_TRUE(curve);
  EXPECT_THAT(curve->points(), ElementsAre(point(0, 0), point(1, 1)));
  EXPECT_DOUBLE_EQ(curve->auc(), 0.5);
  EXPECT_DOUBLE_EQ(curve->truePositiveRateAt(0.2), 0.2);
}

TEST(RocCurve, UnknownScoresWhatItIsGiven) {
  RocSamples samples;
  samples.add(0.9, true);
  samples.add(0.2, false);
  samples.addUnknown(true);
  samples.addUnknown(false);
  // At 0.5 unknown lies between the known ones: (0,0) (0,½) (½,1) (1,1).
  EXPECT_DOUBLE_EQ(samples.curve(0.5)->auc(), 0.5 * 0.75 + 0.5);
  EXPECT_DOUBLE_EQ(samples.curve(0.5)->truePositiveRateAt(0.2), 0.5 + 0.4 * 0.5);
  // At 0 it comes last: (0,0) (0,½) (½,½) (1,1).
  EXPECT_DOUBLE_EQ(samples.curve(0)->auc(), 0.25 + 0.5 * 0.75);
  EXPECT_DOUBLE_EQ(samples.curve(0)->truePositiveRateAt(0.2), 0.5);
  // At a score that is there already it shares the point.
  EXPECT_THAT(samples.curve(0.9)->points(), ElementsAre(point(0, 0), point(0.5, 1), point(1, 1)));
}

TEST(RocCurve, OneKindAloneHasNone) {
  RocSamples samples;
  samples.add(0.9, true);
  samples.addUnknown(true);
  EXPECT_FALSE(samples.curve(0.5));
  EXPECT_FALSE(RocSamples().curve(0.5));
}

TEST(RocCurve, ThinnedKeepsEndsAndArea) {
  RocSamples samples;
  for (int i = 0; i < 5000; ++i) {
    samples.add(i, i % 3 != 0);
    samples.add(i - 2000.5, false);
  }
  const auto curve = samples.curve(0);
  const auto points = curve->thinned(100);
  EXPECT_LE(points.size(), 100U);
  EXPECT_GE(points.size(), 50U);
  EXPECT_THAT(points.front(), point(0, 0));
  EXPECT_THAT(points.back(), point(1, 1));
  EXPECT_NEAR(RocCurve(points).auc(), curve->auc(), 1e-3);
}

}  // namespace
}  // namespace csom
