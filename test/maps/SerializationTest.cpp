// SPDX-License-Identifier: BSD-3-Clause
// The map in MRPT's streams: complete, and safe against damaged ones.
#include <csom/maps/CSemanticContinuousMap.h>
#include <gtest/gtest.h>
#include <mrpt/io/CMemoryStream.h>
#include <mrpt/serialization/CArchive.h>

#include <cstring>
#include <random>

#include "SampleObservations.h"

namespace csom {
namespace {

using testing::roomCloud;
using testing::roomMap;

using Bytes = std::vector<std::uint8_t>;

Bytes serialised(const CSemanticContinuousMap& map) {
  mrpt::io::CMemoryStream stream;
  auto archive = mrpt::serialization::archiveFrom(stream);
  archive << map;
  const auto* begin = static_cast<const std::uint8_t*>(stream.getRawBufferData());
  return {begin, begin + stream.getTotalBytesCount()};
}

void readInto(CSemanticContinuousMap& map, const Bytes& bytes) {
  mrpt::io::CMemoryStream stream;
  stream.assignMemoryNotOwn(bytes.data(), bytes.size());
  auto archive = mrpt::serialization::archiveFrom(stream);
  archive >> map;
}

std::map<std::string, std::string> asText(const Options& options) {
  std::map<std::string, std::string> texts;
  visitOptions(options, [&](const char* key, const auto& field, const char*, const char*) {
    texts[key] = toString(field);
  });
  return texts;
}

CSemanticContinuousMap fullMap() {
  CSemanticContinuousMap map = roomMap();
  map.announce_damaged = false;
  map.insertObservation(*roomCloud(0.3f), mrpt::poses::CPose3D(0.5, 0, 0, 0.1, 0, 0));
  map.insertObservation(mrpt::obs::CObservationPointCloud());
  map.insertObservation(*testing::pointCloud({{1e30f, 0, 0}}, {40}));
  map.insertionOptions.unlabelled_class = "road";
  map.insertionOptions.scan_2d_class = "wall";
  map.likelihoodOptions.decimation = 3;
  map.likelihoodOptions.max_distance = 0.75;
  map.likelihoodOptions.sigma = 0.125;
  map.renderingOptions.occupied_voxels = false;
  map.renderingOptions.free_voxels = true;
  map.genericMapParams.enableSaveAs3DObject = false;
  map.genericMapParams.enableObservationInsertion = false;
  return map;
}

TEST(Serialization, carriesEverything) {
  const CSemanticContinuousMap map = fullMap();
  CSemanticContinuousMap copy;
  readInto(copy, serialised(map));

  EXPECT_EQ(mapDigest(copy.map()), mapDigest(map.map()));
  EXPECT_EQ(asText(copy.map().options()), asText(map.map().options()));
  EXPECT_EQ(copy.labels().toYaml(), map.labels().toYaml());
  EXPECT_EQ(copy.insertionOptions.point_labels, PointLabels::ByIntensity);
  EXPECT_EQ(copy.insertionOptions.unlabelled_class, "road");
  EXPECT_EQ(copy.insertionOptions.scan_2d_class, "wall");
  EXPECT_EQ(copy.likelihoodOptions.decimation, 3);
  EXPECT_EQ(copy.likelihoodOptions.max_distance, 0.75);
  EXPECT_EQ(copy.likelihoodOptions.sigma, 0.125);
  EXPECT_FALSE(copy.renderingOptions.occupied_voxels);
  EXPECT_TRUE(copy.renderingOptions.free_voxels);
  EXPECT_FALSE(copy.genericMapParams.enableSaveAs3DObject);
  EXPECT_FALSE(copy.genericMapParams.enableObservationInsertion);
  EXPECT_TRUE(copy.genericMapParams.enableObservationLikelihood);
}

TEST(Serialization, carriesScanRecordsAndStatistics) {
  const CSemanticContinuousMap map = fullMap();
  CSemanticContinuousMap copy;
  readInto(copy, serialised(map));
  ASSERT_EQ(copy.scans().size(), 2u);
  for (std::size_t i = 0; i < 2; ++i) {
    const ScanRecord& a = copy.scans()[i];
    const ScanRecord& b = map.scans()[i];
    EXPECT_EQ(a.timestamp, b.timestamp);
    EXPECT_EQ(a.sensor_label, b.sensor_label);
    EXPECT_EQ(a.observation_class, b.observation_class);
    EXPECT_EQ(a.origin, b.origin);
    EXPECT_EQ(a.report.points, b.report.points);
    EXPECT_EQ(a.report.rejected, b.report.rejected);
    EXPECT_EQ(a.report.voxels_updated, b.report.voxels_updated);
    EXPECT_EQ(a.report.commit_ms, b.report.commit_ms);
  }
  EXPECT_EQ(copy.statistics().inserted, 2u);
  EXPECT_EQ(copy.statistics().without_points, 1u);
  EXPECT_EQ(copy.statistics().unused.points, 1u);
  EXPECT_EQ(copy.statistics().damaged, map.statistics().damaged);
  EXPECT_EQ(copy.statistics().why_damaged, map.statistics().why_damaged);
  EXPECT_EQ(copy.statistics().labels.labelled, map.statistics().labels.labelled);
}

TEST(Serialization, equalMapsAreEqualBytes) {
  const Bytes first = serialised(fullMap());
  CSemanticContinuousMap copy;
  readInto(copy, first);
  EXPECT_EQ(serialised(copy), first);
}

TEST(Serialization, worksThroughTheClassFactory) {
  const CSemanticContinuousMap map = roomMap();
  mrpt::io::CMemoryStream stream;
  auto archive = mrpt::serialization::archiveFrom(stream);
  archive << map;
  stream.Seek(0);
  mrpt::serialization::CSerializable::Ptr object;
  archive >> object;
  const auto copy = std::dynamic_pointer_cast<CSemanticContinuousMap>(object);
  ASSERT_NE(copy, nullptr);
  EXPECT_EQ(mapDigest(copy->map()), mapDigest(map.map()));
}

TEST(Serialization, emptyMapsToo) {
  CSemanticContinuousMap copy = roomMap();
  readInto(copy, serialised(CSemanticContinuousMap()));
  EXPECT_TRUE(copy.isEmpty());
  EXPECT_TRUE(copy.scans().empty());
}

TEST(Serialization, truncatedStreamsAreErrorsAndChangeNothing) {
  const Bytes bytes = serialised(fullMap());
  CSemanticContinuousMap map = roomMap();
  const std::string digest = mapDigest(map.map());
  const std::size_t step = std::max<std::size_t>(1, bytes.size() / 300);
  for (std::size_t size = 1; size < bytes.size(); size += step) {
    const Bytes truncated(bytes.begin(), bytes.begin() + static_cast<std::ptrdiff_t>(size));
    EXPECT_THROW(readInto(map, truncated), std::exception) << size;
  }
  EXPECT_EQ(mapDigest(map.map()), digest);
  EXPECT_EQ(map.scans().size(), 1u);
}

TEST(Serialization, flippedBytesAreErrors) {
  const Bytes bytes = serialised(fullMap());
  std::mt19937 random(3);
  // Behind the name of the class, which MRPT itself checks.
  std::uniform_int_distribution<std::size_t> position(40, bytes.size() - 2);
  for (int i = 0; i < 300; ++i) {
    Bytes damaged = bytes;
    damaged[position(random)] ^= static_cast<std::uint8_t>(1U << (random() % 8));
    CSemanticContinuousMap map;
    EXPECT_THROW(readInto(map, damaged), std::exception);
  }
}

TEST(Serialization, hugeSizesAreNotBelieved) {
  Bytes bytes = serialised(CSemanticContinuousMap());
  // The block's size follows the name of the class and the version.
  const std::string name = "csom::CSemanticContinuousMap";
  const auto found = std::search(bytes.begin(), bytes.end(), name.begin(), name.end());
  ASSERT_NE(found, bytes.end());
  const std::size_t size_at = static_cast<std::size_t>(found - bytes.begin()) + name.size() + 1;
  const std::uint64_t huge = std::uint64_t{1} << 60U;
  std::memcpy(&bytes[size_at], &huge, sizeof huge);
  CSemanticContinuousMap map;
  EXPECT_THROW(readInto(map, bytes), std::exception);
}

}  // namespace
}  // namespace csom
