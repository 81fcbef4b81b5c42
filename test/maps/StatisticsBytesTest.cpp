// SPDX-License-Identifier: BSD-3-Clause
// Statistics in MRPT's streams: by name, and nothing that is no count.
#include "StatisticsBytes.h"

#include <csom/vision/CameraStatistics.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>
#include <map>
#include <stdexcept>
#include <string>

namespace csom {
namespace {

using testing::HasSubstr;
using Figures = std::map<std::string, double>;

CameraStatistics read(const ByteWriter& bytes) {
  ByteReader in(bytes.bytes().data(), bytes.bytes().size());
  CameraStatistics statistics;
  readStatistics(in, statistics);
  EXPECT_EQ(in.left(), 0u);
  return statistics;
}

CameraStatistics read(const Figures& figures) {
  ByteWriter bytes;
  bytes.named(figures);
  return read(bytes);
}

/// What reading them throws; empty if nothing.
template <class Written>
std::string refusal(const Written& written) {
  try {
    read(written);
  } catch (const std::runtime_error& e) {
    return e.what();
  }
  return {};
}

TEST(StatisticsBytes, AreReadAsTheyWereWritten) {
  CameraStatistics statistics;
  statistics.scans.labelled = 7;
  statistics.points.hidden = std::size_t{1} << 53U;
  statistics.seconds.network = 0.125;
  ByteWriter bytes;
  writeStatistics(bytes, statistics);
  const CameraStatistics copy = read(bytes);
  EXPECT_EQ(copy.scans.labelled, 7u);
  EXPECT_EQ(copy.points.hidden, std::size_t{1} << 53U);
  EXPECT_EQ(copy.seconds.network, 0.125);
  EXPECT_EQ(copy.scans.late, 0u);
}

TEST(StatisticsBytes, WhatIsMissingIsZero) {
  EXPECT_EQ(read(Figures{{"scans.labelled", 2}}).scans.labelled, 2u);
  EXPECT_EQ(read(Figures{}).scans.labelled, 0u);
}

TEST(StatisticsBytes, WhatIsNoCountIsRefusedByName) {
  for (const double value : {-1.0, 0.5, 1e16, std::numeric_limits<double>::infinity(),
                             std::numeric_limits<double>::quiet_NaN()}) {
    SCOPED_TRACE(value);
    EXPECT_THAT(refusal(Figures{{"scans.labelled", value}}), HasSubstr("'scans.labelled' = "));
  }
  EXPECT_THAT(refusal(Figures{{"seconds.network", -1}}), HasSubstr("'seconds.network' = -1"));
  EXPECT_EQ(refusal(Figures{{"seconds.network", 0.5}}), "");
}

TEST(StatisticsBytes, WhatIsNotKnownIsRefusedByName) {
  EXPECT_THAT(refusal(Figures{{"scans.of_tomorrow", 1}}),
              HasSubstr("unknown figure 'scans.of_tomorrow'"));
}

TEST(StatisticsBytes, WhatIsThereTwiceIsRefusedByName) {
  ByteWriter bytes;
  bytes.number(std::uint64_t{2});
  for (const double value : {1.0, 2.0}) {
    bytes.text("scans.labelled");
    bytes.number(value);
  }
  EXPECT_THAT(refusal(bytes), HasSubstr("'scans.labelled' is there twice"));
}

}  // namespace
}  // namespace csom
