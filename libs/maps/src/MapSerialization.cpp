// SPDX-License-Identifier: BSD-3-Clause
// The map as an object of MRPT's streams. CMultiMetricMap copies maps this way, in a particle
// filter hundreds of times: all that counts is copied as one block, without compression.
#include <csom/core/Error.h>
#include <csom/maps/CSemanticContinuousMap.h>
#include <mrpt/serialization/CArchive.h>
#include <xxhash.h>

#include <algorithm>
#include <stdexcept>

#include "ByteStream.h"

namespace csom {
namespace {

constexpr std::uint8_t kVersion = 0;

using Texts = std::map<std::string, std::string>;
using Counts = std::map<std::string, std::size_t>;

void write(ByteWriter& out, const Texts& texts) {
  out.number(static_cast<std::uint64_t>(texts.size()));
  for (const auto& [key, value] : texts) {
    out.text(key);
    out.text(value);
  }
}

Texts readTexts(ByteReader& in) {
  constexpr std::size_t kSmallest = 8;
  Texts texts;
  for (std::size_t left = in.count(kSmallest); left > 0; --left) {
    const std::string key = in.text();
    texts[key] = in.text();
  }
  return texts;
}

void write(ByteWriter& out, const Counts& counts) {
  out.number(static_cast<std::uint64_t>(counts.size()));
  for (const auto& [key, count] : counts) {
    out.text(key);
    out.number(static_cast<std::uint64_t>(count));
  }
}

Counts readCounts(ByteReader& in) {
  constexpr std::size_t kSmallest = 12;
  Counts counts;
  for (std::size_t left = in.count(kSmallest); left > 0; --left) {
    const std::string key = in.text();
    counts[key] = in.number<std::uint64_t>();
  }
  return counts;
}

/// By name, so that a later version may add options.
void write(ByteWriter& out, const Options& options) {
  Texts texts;
  visitOptions(options, [&](const char* key, const auto& field, const char*, const char*) {
    texts[key] = toString(field);
  });
  write(out, texts);
}

Options readOptions(ByteReader& in) {
  Options options;
  for (const auto& [key, text] : readTexts(in)) {
    if (!setOption(options, key, text))
      throw std::runtime_error("serialised map: unknown option '" + key + "'");
  }
  return options;
}

void write(ByteWriter& out, const LabelCounts& counts) {
  for (const std::size_t count : {counts.labelled, counts.unlabelled, counts.missing,
                                  counts.unknown, counts.ignored, counts.ambiguous})
    out.number(static_cast<std::uint64_t>(count));
}

LabelCounts readLabelCounts(ByteReader& in) {
  LabelCounts counts;
  for (std::size_t* count : {&counts.labelled, &counts.unlabelled, &counts.missing, &counts.unknown,
                             &counts.ignored, &counts.ambiguous})
    *count = in.number<std::uint64_t>();
  return counts;
}

/// Calls visit(field) for every number of a report.
template <class Report, class Visitor>
void visitReport(Report& report, Visitor&& visit) {
  visit(report.points);
  for (auto& count : report.rejected) visit(count);
  visit(report.training_points);
  visit(report.free_points);
  visit(report.free_voxels);
  visit(report.blocks_observed);
  visit(report.blocks_filled);
  visit(report.voxels_updated);
  visit(report.prepare_ms);
  visit(report.infer_ms);
  visit(report.commit_ms);
}

void write(ByteWriter& out, const ScanReport& report) {
  visitReport(report, [&](const auto& field) { out.number(field); });
}

ScanReport readReport(ByteReader& in) {
  ScanReport report;
  visitReport(report, [&](auto& field) { field = in.number<std::decay_t<decltype(field)>>(); });
  return report;
}

void write(ByteWriter& out, const InsertionStatistics& statistics) {
  out.number(static_cast<std::uint64_t>(statistics.inserted));
  out.number(static_cast<std::uint64_t>(statistics.without_points));
  write(out, statistics.not_taken);
  write(out, statistics.damaged);
  write(out, statistics.why_damaged);
  write(out, statistics.labels);
  write(out, statistics.unused);
}

InsertionStatistics readStatistics(ByteReader& in) {
  InsertionStatistics statistics;
  statistics.inserted = in.number<std::uint64_t>();
  statistics.without_points = in.number<std::uint64_t>();
  statistics.not_taken = readCounts(in);
  statistics.damaged = readCounts(in);
  statistics.why_damaged = readTexts(in);
  statistics.labels = readLabelCounts(in);
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

/// The announced size is believed piece by piece: a wrong one ends with the stream, not with the
/// memory.
std::vector<std::uint8_t> readBlock(mrpt::serialization::CArchive& in) {
  constexpr std::uint64_t kPiece = 1U << 24U;
  auto left = in.ReadAs<std::uint64_t>();
  const auto hash = in.ReadAs<std::uint64_t>();
  std::vector<std::uint8_t> block;
  while (left > 0) {
    const auto size = static_cast<std::size_t>(std::min(left, kPiece));
    const std::size_t begin = block.size();
    block.resize(begin + size);
    if (in.ReadBuffer(block.data() + begin, size) != size)
      throw std::runtime_error("serialised map: the stream ends in the middle of it");
    left -= size;
  }
  if (XXH3_64bits(block.data(), block.size()) != hash)
    throw std::runtime_error("serialised map: the bytes are not those that were written");
  return block;
}

}  // namespace

std::uint8_t CSemanticContinuousMap::serializeGetVersion() const {
  return kVersion;
}

void CSemanticContinuousMap::serializeTo(mrpt::serialization::CArchive& out) const {
  ByteWriter block;
  block.reserve(map_.memoryBytes() + 512 * scans_.size());
  for (const bool flag :
       {genericMapParams.enableSaveAs3DObject, genericMapParams.enableObservationLikelihood,
        genericMapParams.enableObservationInsertion, renderingOptions.occupied_voxels,
        renderingOptions.free_voxels})
    block.number(static_cast<std::uint8_t>(flag));
  block.text(toString(insertionOptions.point_labels));
  block.text(insertionOptions.unlabelled_class);
  block.text(insertionOptions.scan_2d_class);
  block.number(static_cast<std::int32_t>(likelihoodOptions.decimation));
  block.number(likelihoodOptions.max_distance);
  block.number(likelihoodOptions.sigma);
  write(block, map_.options());
  block.text(labels_->toYaml());
  write(block, meta_);
  write(block, statistics_);
  write(block, scans_);
  write(block, map_.chunks());

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
  const std::vector<std::uint8_t> bytes = readBlock(in);
  ByteReader block(bytes);
  mrpt::maps::TMapGenericParams generic;
  TRenderingOptions rendering;
  for (bool* flag :
       {&generic.enableSaveAs3DObject, &generic.enableObservationLikelihood,
        &generic.enableObservationInsertion, &rendering.occupied_voxels, &rendering.free_voxels})
    *flag = block.flag();
  TInsertionOptions insertion;
  parse("point_labels", block.text(), insertion.point_labels);
  insertion.unlabelled_class = block.text();
  insertion.scan_2d_class = block.text();
  TLikelihoodOptions likelihood;
  likelihood.decimation = block.number<std::int32_t>();
  likelihood.max_distance = block.number<double>();
  likelihood.sigma = block.number<double>();
  likelihood.validate();
  MapDocument document{SemanticMap(readOptions(block)),
                       LabelSet::fromYaml(block.text(), "serialised map"),
                       {},
                       readTexts(block)};
  InsertionStatistics statistics = readStatistics(block);
  document.scans = readScans(block);
  readChunks(block, document.map);
  if (block.left() > 0) throw std::runtime_error("serialised map: bytes after its end");

  // Everything is there: from here on nothing throws but setDocument, before it changes anything.
  setDocument(std::move(document));
  statistics_ = std::move(statistics);
  genericMapParams = generic;
  insertionOptions = insertion;
  likelihoodOptions = likelihood;
  renderingOptions = rendering;
}

}  // namespace csom
