// SPDX-License-Identifier: BSD-3-Clause
#include <csom/eval/Calibration.h>
#include <gtest/gtest.h>

namespace csom {
namespace {

TEST(Calibration, OfThreeStatements) {
  Calibration calibration;
  calibration.add({0.1, 0.9}, 1);
  calibration.add({0.08, 0.92}, 0);  // same bin of 15: [0.8667, 0.9333)
  calibration.add({0.4, 0.3, 0.3}, 0);
  EXPECT_EQ(calibration.count(), 3U);
  const double first = 2 * 0.1 * 0.1;
  const double second = 2 * 0.92 * 0.92;
  const double third = 0.6 * 0.6 + 2 * 0.3 * 0.3;
  EXPECT_DOUBLE_EQ(calibration.brier(), (first + second + third) / 3);
  // One of two right at 1.82 in sum; one right at 0.4.
  EXPECT_DOUBLE_EQ(calibration.expectedCalibrationError(), (0.82 + 0.6) / 3);
  EXPECT_EQ(calibration.bins()[13].count, 2U);
  EXPECT_EQ(calibration.bins()[13].correct, 1U);
  EXPECT_EQ(calibration.bins()[6].count, 1U);
}

TEST(Calibration, CertaintyThatIsRightCostsNothing) {
  Calibration calibration;
  calibration.add({0, 1}, 1);
  calibration.add({1, 0}, 0);
  EXPECT_EQ(calibration.brier(), 0);
  EXPECT_EQ(calibration.expectedCalibrationError(), 0);
  EXPECT_EQ(calibration.bins()[14].count, 2U);
}

TEST(Calibration, AClassBeyondTheDistributionHasProbabilityZero) {
  Calibration calibration;
  calibration.add({0.5, 0.5}, 7);
  EXPECT_DOUBLE_EQ(calibration.brier(), 1 + 2 * 0.25);
  EXPECT_DOUBLE_EQ(calibration.expectedCalibrationError(), 0.5);
}

TEST(Calibration, NothingIsZero) {
  EXPECT_EQ(Calibration().brier(), 0);
  EXPECT_EQ(Calibration().expectedCalibrationError(), 0);
}

}  // namespace
}  // namespace csom
