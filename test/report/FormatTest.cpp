// SPDX-License-Identifier: BSD-3-Clause
// Figures in words: rounding, units, grouping.
#include <csom/report/Format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace csom {
namespace {

TEST(FormatTest, CountsAreGroupedByThousands) {
  EXPECT_EQ(formatCount(0), "0");
  EXPECT_EQ(formatCount(999), "999");
  EXPECT_EQ(formatCount(1000), "1,000");
  EXPECT_EQ(formatCount(123456), "123,456");
  EXPECT_EQ(formatCount(1234567), "1,234,567");
}

TEST(FormatTest, NounsAgreeWithTheirCount) {
  EXPECT_EQ(formatCount(0, "point"), "0 points");
  EXPECT_EQ(formatCount(1, "point"), "1 point");
  EXPECT_EQ(formatCount(2000, "point"), "2,000 points");
}

TEST(FormatTest, NumbersHaveThreeSignificantDigits) {
  EXPECT_EQ(formatNumber(0), "0");
  EXPECT_EQ(formatNumber(0.0123456), "0.0123");
  EXPECT_EQ(formatNumber(0.2), "0.2");
  EXPECT_EQ(formatNumber(1.2345), "1.23");
  EXPECT_EQ(formatNumber(-12.345), "-12.3");
  EXPECT_EQ(formatNumber(9.999), "10");
  EXPECT_EQ(formatNumber(123.456), "123");
  EXPECT_EQ(formatNumber(12345), "12300");
}

TEST(FormatTest, ExtremeNumbersAreHarmless) {
  EXPECT_EQ(formatNumber(std::nan("")), "–");
  EXPECT_EQ(formatNumber(std::numeric_limits<double>::infinity()), "–");
  EXPECT_EQ(formatNumber(1e-300), "0");
  EXPECT_EQ(formatNumber(std::numeric_limits<double>::max()).size(), 309u);
}

TEST(FormatTest, LengthsTakeTheFittingUnit) {
  EXPECT_EQ(formatLength(0.05), "5 cm");
  EXPECT_EQ(formatLength(0.2), "20 cm");
  EXPECT_EQ(formatLength(5), "5 m");
  EXPECT_EQ(formatLength(999), "999 m");
  EXPECT_EQ(formatLength(2000), "2 km");
}

TEST(FormatTest, DurationsTakeTheFittingUnit) {
  EXPECT_EQ(formatDuration(0), "0 ms");
  EXPECT_EQ(formatDuration(0.85), "850 ms");
  EXPECT_EQ(formatDuration(12.34), "12.3 s");
  EXPECT_EQ(formatDuration(59.99), "60 s");
  EXPECT_EQ(formatDuration(200), "3 min 20 s");
  EXPECT_EQ(formatDuration(7500), "2 h 5 min");
  EXPECT_EQ(formatDuration(std::nan("")), "–");
}

TEST(FormatTest, BytesTakeTheFittingUnit) {
  EXPECT_EQ(formatBytes(1), "1 byte");
  EXPECT_EQ(formatBytes(999), "999 bytes");
  EXPECT_EQ(formatBytes(1500), "1.5 kB");
  EXPECT_EQ(formatBytes(12'000'000), "12 MB");
  EXPECT_EQ(formatBytes(3'000'000'000'000'000), "3000 TB");
}

TEST(FormatTest, SmallSharesDoNotVanish) {
  EXPECT_EQ(formatShare(0), "0 %");
  EXPECT_EQ(formatShare(1e-9), "< 0.01 %");
  EXPECT_EQ(formatShare(0.123), "12.3 %");
  EXPECT_EQ(formatShare(1), "100 %");
}

}  // namespace
}  // namespace csom
