// SPDX-License-Identifier: BSD-3-Clause
// The map as an object of MRPT's streams. CMultiMetricMap copies maps this way, in a particle
// filter hundreds of times: all that counts is copied as one block, without compression.
#include <csom/core/Error.h>
#include <csom/maps/CSemanticContinuousMap.h>
#include <mrpt/serialization/CArchive.h>
#include <xxhash.h>

#include <algorithm>
#include <cstring>
#include <memory>
#include <stdexcept>

#include "ByteStream.h"
#include "StatisticsBytes.h"

namespace csom {
namespace {

/// 1: labels from cameras. 2: options of the likelihood by name. 3: those of views by name. 4:
/// beams without a return, points of unknown labels that were kept. 5: statistics by name.
constexpr std::uint8_t kVersion = 6;

using Texts = std::map<std::string, std::string>;

/// Options are written and read by name, so that a later version may add some.
/// `visit(visitor)` calls visitor(OptionInfo, field) for each.
template <class Visit>
void writeByName(ByteWriter& out, Visit&& visit) {
  Texts texts;
  visit([&](const OptionInfo& option, const auto& field) { texts[option.key] = toString(field); });
  out.named(texts);
}

template <class Visit>
void readByName(ByteReader& in, Visit&& visit) {
  Texts texts = in.named<std::string>();
  visit([&](const OptionInfo& option, auto& field) {
    const auto text = texts.find(option.key);
    if (text == texts.end()) return;
    parse(option.key, text->second, field);
    texts.erase(text);
  });
  if (!texts.empty())
    throw std::runtime_error("serialised map: unknown option '" + texts.begin()->first + "'");
}

/// Before version 5 some options had no names, but an order.
template <class Visit>
void readInOrder(ByteReader& in, Visit&& visit) {
  visit([&](const OptionInfo& option, auto& field) { parse(option.key, in.text(), field); });
}

void write(ByteWriter& out, const Options& options) {
  writeByName(out, [&](auto&& visitor) { visitOptions(options, visitor); });
}

Options readOptions(ByteReader& in) {
  Options options;
  readByName(in, [&](auto&& visitor) { visitOptions(options, visitor); });
  return options;
}

void write(ByteWriter& out, const LabelOptions& options) {
  writeByName(out, [&](auto&& visitor) { visitOptions(options, visitor); });
  out.number(static_cast<std::uint64_t>(options.sources.size()));
  for (const LabelSource& source : options.sources)
    writeByName(out, [&](auto&& visitor) { visitOptions(source, visitor); });
}

LabelOptions readLabelOptions(ByteReader& in, std::uint8_t version) {
  constexpr std::size_t kSmallest = 5 * sizeof(std::uint32_t);
  LabelOptions options;
  readByName(in, [&](auto&& visitor) { visitOptions(options, visitor); });
  options.sources.resize(in.count(kSmallest));
  for (LabelSource& source : options.sources) {
    const auto visit = [&](auto&& visitor) { visitOptions(source, visitor); };
    if (version >= 5)
      readByName(in, visit);
    else
      readInOrder(in, visit);
  }
  options.validate();
  return options;
}

void write(ByteWriter& out, const LikelihoodOptions& options) {
  writeByName(out, [&](auto&& visitor) { visitOptions(options, visitor); });
}

LikelihoodOptions readLikelihoodOptions(ByteReader& in, std::uint8_t version) {
  LikelihoodOptions options;
  if (version < 2) {
    options.decimation = in.number<std::int32_t>();
    options.max_distance = in.number<double>();
    options.sigma = in.number<double>();
  } else {
    readByName(in, [&](auto&& visitor) { visitOptions(options, visitor); });
  }
  options.validate();
  return options;
}

void write(ByteWriter& out, const RenderingOptions& options) {
  writeByName(out, [&](auto&& visitor) { visitOptions(options, visitor); });
}

RenderingOptions readRenderingOptions(ByteReader& in, std::uint8_t version) {
  RenderingOptions options;
  if (version < 3) {
    options.occupied_voxels = in.flag();
    options.free_voxels = in.flag();
    return options;
  }
  readByName(in, [&](auto&& visitor) { visitOptions(options, visitor); });
  return options;
}

LabelCounts readLabelCounts(ByteReader& in, std::uint8_t version) {
  LabelCounts counts;
  if (version >= 5) {
    readStatistics(in, counts);
    return counts;
  }
  for (std::size_t* count : {&counts.labelled, &counts.unlabelled, &counts.missing, &counts.unknown,
                             &counts.ignored, &counts.ambiguous})
    *count = in.number<std::uint64_t>();
  if (version >= 4) counts.kept_unknown = in.number<std::uint64_t>();
  return counts;
}

void write(ByteWriter& out, const ScanReport& report) {
  visitReport(report, [&](const std::string&, const auto& field) { out.number(field); });
}

ScanReport readReport(ByteReader& in) {
  ScanReport report;
  visitReport(report, [&](const std::string&, auto& field) {
    field = in.number<std::decay_t<decltype(field)>>();
  });
  return report;
}

void write(ByteWriter& out, const InsertionStatistics& statistics) {
  out.number(static_cast<std::uint64_t>(statistics.inserted));
  out.number(static_cast<std::uint64_t>(statistics.without_points));
  out.named(statistics.not_taken);
  out.named(statistics.damaged);
  out.named(statistics.why_damaged);
  writeStatistics(out, statistics.labels);
  out.number(static_cast<std::uint64_t>(statistics.no_returns));
  writeStatistics(out, statistics.images);
  write(out, statistics.unused);
}

InsertionStatistics readInsertionStatistics(ByteReader& in, std::uint8_t version) {
  InsertionStatistics statistics;
  statistics.inserted = in.number<std::uint64_t>();
  statistics.without_points = in.number<std::uint64_t>();
  statistics.not_taken = in.named<std::size_t>();
  statistics.damaged = in.named<std::size_t>();
  statistics.why_damaged = in.named<std::string>();
  statistics.labels = readLabelCounts(in, version);
  if (version >= 4) statistics.no_returns = in.number<std::uint64_t>();
  if (version >= 6) readStatistics(in, statistics.images);
  statistics.unused = readReport(in);
  return statistics;
}

void write(ByteWriter& out, const std::vector<ScanRecord>& scans) {
  out.number(static_cast<std::uint64_t>(scans.size()));
  for (const ScanRecord& scan : scans) {
    out.number(scan.timestamp);
    out.text(scan.sensor_label);
    out.text(scan.observation_class);
    for (const double coordinate : scan.origin) out.number(coordinate);
    write(out, scan.report);
  }
}

std::vector<ScanRecord> readScans(ByteReader& in) {
  constexpr std::size_t kSmallest = 4 * sizeof(double) + 2 * sizeof(std::uint32_t);
  std::vector<ScanRecord> scans(in.count(kSmallest));
  for (ScanRecord& scan : scans) {
    scan.timestamp = in.number<double>();
    scan.sensor_label = in.text();
    scan.observation_class = in.text();
    for (double& coordinate : scan.origin) coordinate = in.number<double>();
    scan.report = readReport(in);
  }
  return scans;
}

void write(ByteWriter& out, const ChunkStore& chunks) {
  out.number(static_cast<std::uint64_t>(chunks.chunkCount()));
  for (const auto& [index, chunk] : chunks.sorted()) {
    out.number(index.x);
    out.number(index.y);
    out.number(index.z);
    out.number(static_cast<std::uint32_t>(chunk->recordSize()));
    out.raw(chunk->record(), chunk->recordSize());
  }
}

void readChunks(ByteReader& in, SemanticMap& map) {
  constexpr std::size_t kSmallest = 4 * sizeof(std::uint32_t);
  for (std::size_t left = in.count(kSmallest); left > 0; --left) {
    ChunkIndex index;
    index.x = in.number<std::int32_t>();
    index.y = in.number<std::int32_t>();
    index.z = in.number<std::int32_t>();
    const auto size = in.number<std::uint32_t>();
    map.addChunkRecord(index, in.raw(size), size);
  }
}

/// Bytes of a stream. Unlike a std::vector it does not fill memory that is overwritten at once,
/// which takes as long as reading.
struct Block {
  std::unique_ptr<std::uint8_t[]> data;
  std::size_t size = 0;
};

/// The stated size is believed piece by piece: a wrong one ends with the stream, not with the
/// memory.
Block readBlock(mrpt::serialization::CArchive& in) {
  constexpr std::uint64_t kFirstPiece = 1U << 24U;
  const auto stated = in.ReadAs<std::uint64_t>();
  const auto hash = in.ReadAs<std::uint64_t>();
  Block block;
  while (block.size < stated) {
    const std::uint64_t next = std::max<std::uint64_t>(kFirstPiece, 2 * block.size);
    const auto size = static_cast<std::size_t>(std::min(stated, next));
    std::unique_ptr<std::uint8_t[]> larger(new std::uint8_t[size]);
    if (block.size > 0) std::memcpy(larger.get(), block.data.get(), block.size);
    block.data = std::move(larger);
    const std::size_t missing = size - block.size;
    if (in.ReadBuffer(block.data.get() + block.size, missing) != missing)
      throw std::runtime_error("serialised map: the stream ends in the middle of it");
    block.size = size;
  }
  if (XXH3_64bits(block.data.get(), block.size) != hash)
    throw std::runtime_error("serialised map: the bytes are not those that were written");
  return block;
}

}  // namespace

std::uint8_t CSemanticContinuousMap::serializeGetVersion() const {
  return kVersion;
}

void CSemanticContinuousMap::serializeTo(mrpt::serialization::CArchive& out) const {
  // One block, written at once: MRPT's stream in memory moves all that it holds for every few
  // kilobytes that are added to it.
  ByteWriter block;
  block.reserve(map_.memoryBytes() + 512 * scans_.size());
  for (const bool flag :
       {genericMapParams.enableSaveAs3DObject, genericMapParams.enableObservationLikelihood,
        genericMapParams.enableObservationInsertion})
    block.number(static_cast<std::uint8_t>(flag));
  write(block, static_cast<const RenderingOptions&>(renderingOptions));
  writeByName(block, [&](auto&& visitor) { visitOptions(insertionOptions, visitor); });
  write(block, static_cast<const LikelihoodOptions&>(likelihoodOptions));
  write(block, labelOptions);
  write(block, map_.options());
  block.text(labels_->yaml());
  block.named(meta_);
  write(block, statistics_);
  write(block, scans_);
  write(block, map_.chunks());
  block.number(static_cast<std::uint8_t>(adapter_ != nullptr));
  if (adapter_) adapter_->writeTo(block);

  const std::vector<std::uint8_t>& bytes = block.bytes();
  out.WriteAs<std::uint64_t>(bytes.size());
  out.WriteAs<std::uint64_t>(XXH3_64bits(bytes.data(), bytes.size()));
  out.WriteBuffer(bytes.data(), bytes.size());
}

void CSemanticContinuousMap::serializeFrom(mrpt::serialization::CArchive& in,
                                           std::uint8_t version) {
  if (version > kVersion) {
    throw std::runtime_error("serialised map: version " + std::to_string(version) +
                             " is later than this program's " + std::to_string(kVersion));
  }
  const Block bytes = readBlock(in);
  ByteReader block(bytes.data.get(), bytes.size);
  mrpt::maps::TMapGenericParams generic;
  for (bool* flag : {&generic.enableSaveAs3DObject, &generic.enableObservationLikelihood,
                     &generic.enableObservationInsertion})
    *flag = block.flag();
  const RenderingOptions rendering = readRenderingOptions(block, version);
  TInsertionOptions insertion;
  const auto visitInsertion = [&](auto&& visitor) { visitOptions(insertion, visitor); };
  if (version >= 5)
    readByName(block, visitInsertion);
  else
    readInOrder(block, visitInsertion);
  const LikelihoodOptions likelihood = readLikelihoodOptions(block, version);
  LabelOptions label_options;
  if (version >= 1) label_options = readLabelOptions(block, version);
  SemanticMap map(readOptions(block));
  std::shared_ptr<const SharedLabels> labels = SharedLabels::fromYaml(block.text());
  // Throws for classes that are not in the label set.
  LabelRules(labels->set(), insertion.point_labels, insertion.unlabelled_class,
             insertion.scan_2d_class);
  Texts meta = block.named<std::string>();
  InsertionStatistics statistics = readInsertionStatistics(block, version);
  std::vector<ScanRecord> scans = readScans(block);
  readChunks(block, map);
  std::unique_ptr<ObservationAdapter> adapter;
  if (version >= 1 && block.flag()) {
    adapter = makeAdapter(label_options, labels->set(), beamsOf(map.options()));
    adapter->readFrom(block, version);
  }
  if (block.left() > 0) throw std::runtime_error("serialised map: bytes after its end");

  // Everything is there: from here on nothing throws but setContent, before it changes anything.
  setContent(std::move(map), std::move(labels), std::move(scans), std::move(meta));
  statistics_ = std::move(statistics);
  genericMapParams = generic;
  insertionOptions = insertion;
  static_cast<LikelihoodOptions&>(likelihoodOptions) = likelihood;
  static_cast<RenderingOptions&>(renderingOptions) = rendering;
  labelOptions = std::move(label_options);
  adapter_ = std::move(adapter);
}

}  // namespace csom
