// SPDX-License-Identifier: BSD-3-Clause
// The map in MRPT's streams: complete, and safe against damaged ones.
#include <csom/maps/CSemanticContinuousMap.h>
#include <gtest/gtest.h>
#include <mrpt/io/CMemoryStream.h>
#include <mrpt/serialization/CArchive.h>
#include <xxhash.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <functional>
#include <limits>
#include <random>

#include "ByteStream.h"
#include "SampleObservations.h"

namespace csom {
namespace {

using sample::roomCloud;
using sample::roomMap;

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

/// The parts of a stream that holds one map: what is before its block, the block, what is behind.
/// Damage in the block gets past the checksum, to the checks that are behind it.
struct Parts {
  Bytes front;
  Bytes block;
  Bytes back;

  explicit Parts(const Bytes& bytes) {
    // The block's size and checksum follow the name of the class and the version.
    const std::string name = "csom::CSemanticContinuousMap";
    auto begin = std::search(bytes.begin(), bytes.end(), name.begin(), name.end());
    begin += static_cast<std::ptrdiff_t>(name.size() + 1);
    std::uint64_t size = 0;
    std::memcpy(&size, &*begin, sizeof size);
    const auto block_at = begin + 16;
    const auto block_end = block_at + static_cast<std::ptrdiff_t>(size);
    front.assign(bytes.begin(), begin);
    block.assign(block_at, block_end);
    back.assign(block_end, bytes.end());
  }

  Bytes joined() const {
    Bytes bytes = front;
    for (const std::uint64_t number :
         {static_cast<std::uint64_t>(block.size()), XXH3_64bits(block.data(), block.size())}) {
      const auto* begin = reinterpret_cast<const std::uint8_t*>(&number);
      bytes.insert(bytes.end(), begin, begin + sizeof number);
    }
    bytes.insert(bytes.end(), block.begin(), block.end());
    bytes.insert(bytes.end(), back.begin(), back.end());
    return bytes;
  }
};

/// Reads a map and, if that is no error, uses it. Returns whether it was read.
bool isReadOrRejected(const Bytes& bytes) {
  CSemanticContinuousMap map;
  try {
    readInto(map, bytes);
  } catch (const std::exception&) {
    return false;
  }
  CSemanticContinuousMap copy;
  readInto(copy, serialised(map));
  EXPECT_EQ(mapDigest(copy.map()), mapDigest(map.map()));
  EXPECT_EQ(map.map().options().number_of_classes, map.labels().numberOfClasses());
  map.map().forEachVoxel([&](const VoxelIndex&, const DirichletVoxel& voxel) {
    EXPECT_LT(voxel.mostLikelyClass(), map.labels().numberOfClasses());
  });
  EXPECT_FALSE(std::isnan(map.computeObservationLikelihood(*sample::pointCloud({{1, 0, 0}}, {40}),
                                                           mrpt::poses::CPose3D())));
  return true;
}

std::map<std::string, std::string> asText(const Options& options) {
  std::map<std::string, std::string> texts;
  visitOptions(options, [&](const OptionInfo& option, const auto& field) {
    texts[option.key] = toString(field);
  });
  return texts;
}

CSemanticContinuousMap fullMap() {
  CSemanticContinuousMap map = roomMap();
  map.warn_of_damaged = false;
  map.insertObservation(*roomCloud(0.3f), mrpt::poses::CPose3D(0.5, 0, 0, 0.1, 0, 0));
  map.insertObservation(mrpt::obs::CObservationPointCloud());
  map.insertObservation(*sample::pointCloud({{1e30f, 0, 0}}, {40}));
  map.insertionOptions.unlabelled_class = "road";
  map.insertionOptions.scan_2d_class = "wall";
  map.likelihoodOptions.decimation = 3;
  map.likelihoodOptions.max_distance = 0.75;
  map.likelihoodOptions.sigma = 0.125;
  map.likelihoodOptions.method = LikelihoodMethod::Beam;
  map.likelihoodOptions.semantic_weight = 1.75;
  map.likelihoodOptions.label_error = 0.375;
  map.renderingOptions.occupied_voxels = false;
  map.renderingOptions.free_voxels = true;
  map.renderingOptions.color_by = VoxelColor::Height;
  map.genericMapParams.enableSaveAs3DObject = false;
  map.genericMapParams.enableObservationInsertion = false;
  return map;
}

TEST(Serialization, CarriesEverything) {
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
  EXPECT_EQ(copy.likelihoodOptions.method, LikelihoodMethod::Beam);
  EXPECT_EQ(copy.likelihoodOptions.semantic_weight, 1.75);
  EXPECT_EQ(copy.likelihoodOptions.label_error, 0.375);
  EXPECT_FALSE(copy.renderingOptions.occupied_voxels);
  EXPECT_TRUE(copy.renderingOptions.free_voxels);
  EXPECT_EQ(copy.renderingOptions.color_by, VoxelColor::Height);
  EXPECT_FALSE(copy.genericMapParams.enableSaveAs3DObject);
  EXPECT_FALSE(copy.genericMapParams.enableObservationInsertion);
  EXPECT_TRUE(copy.genericMapParams.enableObservationLikelihood);
}

/// What `version` of the format wrote for fullMap(), whose bytes of today are `today`.
Bytes asWrittenBy(std::uint8_t version, const Bytes& today) {
  Parts parts(today);
  ByteReader in(parts.block.data(), parts.block.size());
  ByteWriter out;
  const auto copyBytes = [&](std::size_t size, ByteWriter& to) { to.raw(in.raw(size), size); };
  const auto copyTexts = [&](std::uint64_t count, ByteWriter& to) {
    for (; count > 0; --count) to.text(in.text());
  };
  const auto copyOptions = [&](ByteWriter& to) {
    const auto count = in.number<std::uint64_t>();
    to.number(count);
    copyTexts(2 * count, to);
  };
  ByteWriter later;  // what that version did not have, or had otherwise
  const CSemanticContinuousMap map = fullMap();

  copyBytes(3, out);
  copyOptions(version < 3 ? later : out);
  if (version < 3) {
    out.number(static_cast<std::uint8_t>(map.renderingOptions.occupied_voxels));
    out.number(static_cast<std::uint8_t>(map.renderingOptions.free_voxels));
  }
  copyOptions(version < 5 ? later : out);
  if (version < 5) {
    const auto& options = map.insertionOptions;
    for (const std::string& text :
         {toString(options.point_labels), options.unlabelled_class, options.scan_2d_class})
      out.text(text);
  }
  copyOptions(version < 2 ? later : out);
  if (version < 2) {
    out.number(static_cast<std::int32_t>(map.likelihoodOptions.decimation));
    out.number(map.likelihoodOptions.max_distance);
    out.number(map.likelihoodOptions.sigma);
  }
  copyOptions(version < 1 ? later : out);
  copyBytes(sizeof(std::uint64_t), version < 1 ? later : out);  // number of label sources: none
  copyOptions(out);
  out.text(in.text());  // labels
  copyOptions(out);     // meta
  const auto copyCounts = [&] {
    const auto count = in.number<std::uint64_t>();
    out.number(count);
    for (std::uint64_t left = count; left > 0; --left) {
      out.text(in.text());
      copyBytes(sizeof(std::uint64_t), out);
    }
  };
  copyBytes(2 * sizeof(std::uint64_t), out);
  copyCounts();
  copyCounts();
  copyOptions(out);                                 // reasons
  const auto figures = in.number<std::uint64_t>();  // points by their labels
  (version < 5 ? later : out).number(figures);
  for (std::uint64_t left = figures; left > 0; --left) {
    copyTexts(1, version < 5 ? later : out);
    copyBytes(sizeof(double), version < 5 ? later : out);
  }
  if (version < 5) {
    const LabelCounts& labels = map.statistics().labels;
    for (const std::size_t count : {labels.labelled, labels.unlabelled, labels.missing,
                                    labels.unknown, labels.ignored, labels.ambiguous})
      out.number(static_cast<std::uint64_t>(count));
    if (version >= 4) out.number(static_cast<std::uint64_t>(labels.kept_unknown));
  }
  copyBytes(sizeof(std::uint64_t), version < 4 ? later : out);  // beams without return
  const auto image_counts = in.number<std::uint64_t>();
  if (version >= 6) out.number(image_counts);
  for (std::uint64_t left = image_counts; left > 0; --left) {
    copyTexts(1, version < 6 ? later : out);
    copyBytes(sizeof(double), version < 6 ? later : out);
  }
  copyBytes(in.left() - 1, out);
  copyBytes(1, version < 1 ? later : out);  // is there an adapter? no
  parts.front.back() = version;
  parts.block = out.bytes();
  return parts.joined();
}

TEST(Serialization, ReadsWhatEarlierVersionsWrote) {
  CSemanticContinuousMap map = fullMap();
  map.labelOptions.max_time_offset = 0.0625;
  const Bytes today = serialised(map);
  ASSERT_EQ(asWrittenBy(6, today), today) << "the test does not follow the format any more";
  for (std::uint8_t version = 0; version < 6; ++version) {
    SCOPED_TRACE(static_cast<int>(version));
    CSemanticContinuousMap copy;
    readInto(copy, asWrittenBy(version, today));
    EXPECT_EQ(mapDigest(copy.map()), mapDigest(map.map()));
    EXPECT_EQ(copy.scans().size(), map.scans().size());
    EXPECT_FALSE(copy.renderingOptions.occupied_voxels);
    EXPECT_TRUE(copy.renderingOptions.free_voxels);
    EXPECT_EQ(copy.renderingOptions.color_by,
              version < 3 ? VoxelColor::Class : map.renderingOptions.color_by);
    EXPECT_EQ(copy.likelihoodOptions.decimation, 3);
    EXPECT_EQ(copy.likelihoodOptions.max_distance, 0.75);
    EXPECT_EQ(copy.likelihoodOptions.sigma, 0.125);
    EXPECT_EQ(copy.likelihoodOptions.method,
              version < 2 ? LikelihoodOptions().method : LikelihoodMethod::Beam);
    EXPECT_EQ(copy.insertionOptions.point_labels, PointLabels::ByIntensity);
    EXPECT_EQ(copy.insertionOptions.unlabelled_class, "road");
    EXPECT_EQ(copy.insertionOptions.scan_2d_class, "wall");
    EXPECT_EQ(copy.statistics().labels.labelled, map.statistics().labels.labelled);
    EXPECT_EQ(copy.labelOptions.max_time_offset,
              version < 1 ? LabelOptions().max_time_offset : 0.0625);
  }
}

TEST(Serialization, CarriesScanRecordsAndStatistics) {
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

TEST(Serialization, EqualMapsAreEqualBytes) {
  const Bytes first = serialised(fullMap());
  CSemanticContinuousMap copy;
  readInto(copy, first);
  EXPECT_EQ(serialised(copy), first);
}

TEST(Serialization, WorksThroughTheClassFactory) {
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

TEST(Serialization, EmptyMapsToo) {
  CSemanticContinuousMap copy = roomMap();
  readInto(copy, serialised(CSemanticContinuousMap()));
  EXPECT_TRUE(copy.isEmpty());
  EXPECT_TRUE(copy.scans().empty());
}

TEST(Serialization, TruncatedStreamsAreErrorsAndChangeNothing) {
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

TEST(Serialization, FlippedBytesAreErrors) {
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

TEST(Serialization, DamageWithAValidChecksumIsAnErrorOrAValidMap) {
  const Parts parts(serialised(fullMap()));
  ASSERT_EQ(Parts(parts.joined()).block, parts.block);
  ASSERT_TRUE(isReadOrRejected(parts.joined()));
  std::mt19937 random(4);
  std::size_t read = 0;
  std::size_t rejected = 0;
  const auto flip = [&](std::size_t position) {
    Parts damaged = parts;
    damaged.block[position] ^= static_cast<std::uint8_t>(1U << (random() % 8));
    ++(isReadOrRejected(damaged.joined()) ? read : rejected);
  };
  // Most of what is checked stands before the voxels.
  const std::size_t head = std::min<std::size_t>(parts.block.size(), 4000);
  for (std::size_t position = 0; position < head; position += 3) flip(position);
  for (int i = 0; i < 500; ++i) flip(random() % parts.block.size());
  EXPECT_GT(read, 0u);
  EXPECT_GT(rejected, 0u);
}

TEST(Serialization, ShortOrLongBlocksWithAValidChecksumAreErrors) {
  const Parts parts(serialised(fullMap()));
  const std::size_t step = std::max<std::size_t>(1, parts.block.size() / 500);
  for (std::size_t size = 0; size < parts.block.size(); size += step) {
    Parts shorter = parts;
    shorter.block.resize(size);
    EXPECT_FALSE(isReadOrRejected(shorter.joined())) << size;
  }
  Parts longer = parts;
  longer.block.push_back(0);
  EXPECT_FALSE(isReadOrRejected(longer.joined()));
}

TEST(Serialization, OptionsAreChecked) {
  using Map = CSemanticContinuousMap;
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const std::vector<std::function<void(Map&)>> faults = {
      [](Map& map) { map.likelihoodOptions.sigma = 0; },
      [nan](Map& map) { map.likelihoodOptions.sigma = nan; },
      [nan](Map& map) { map.likelihoodOptions.max_distance = nan; },
      [](Map& map) { map.likelihoodOptions.decimation = 0; },
      [](Map& map) { map.insertionOptions.unlabelled_class = "lawn"; }};
  for (const auto& fault : faults) {
    Map map = roomMap();
    fault(map);
    Map copy;
    EXPECT_THROW(readInto(copy, serialised(map)), std::exception);
    EXPECT_TRUE(copy.isEmpty());
  }
}

TEST(Serialization, LabelSetsAreNotMixedUp) {
  const CSemanticContinuousMap occupancy;
  const CSemanticContinuousMap room = roomMap();
  CSemanticContinuousMap copy;
  for (int i = 0; i < 2; ++i) {
    readInto(copy, serialised(room));
    EXPECT_EQ(copy.labels(), room.labels());
    readInto(copy, serialised(occupancy));
    EXPECT_EQ(copy.labels(), occupancy.labels());
  }
}

TEST(Serialization, HugeSizesAreNotBelieved) {
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
