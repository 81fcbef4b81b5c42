// SPDX-License-Identifier: BSD-3-Clause
// Maps in MRPT's streams. The input is what stands between the checksum and the end: the checksum,
// which keeps random bytes away from all that follows, is made right.
#include <csom/maps/CSemanticContinuousMap.h>
#include <mrpt/io/CMemoryStream.h>
#include <mrpt/serialization/CArchive.h>
#include <xxhash.h>

#include <cstdlib>
#include <cstring>
#include <new>
#include <stdexcept>
#include <vector>

#include "FuzzTarget.h"

extern "C" std::size_t LLVMFuzzerMutate(std::uint8_t* data, std::size_t size, std::size_t max_size);
extern "C" std::size_t LLVMFuzzerCustomMutator(std::uint8_t* data, std::size_t size,
                                               std::size_t max_size, unsigned seed);

namespace {

using Bytes = std::vector<std::uint8_t>;

/// A small map with voxels and a scan.
csom::CSemanticContinuousMap sampleMap() {
  csom::Options options;
  options.method = csom::Method::SCsm;
  options.resolution = 0.5;
  csom::Scan scan;
  scan.points = {{1.0F, 0.0F, 0.2F}, {1.2F, 0.4F, 0.2F}, {-3.0F, 2.0F, 0.9F}};
  scan.labels = {1, 1, 1};
  csom::MapDocument document;
  document.map = csom::SemanticMap(options);
  csom::ScanRecord record;
  record.sensor_label = "lidar";
  record.observation_class = "CObservationPointCloud";
  record.report = document.map.insert(scan);
  document.scans.push_back(record);
  csom::CSemanticContinuousMap map(options);
  map.setDocument(document);
  return map;
}

/// An object as MRPT writes it: class name and version, size and checksum, block, end mark.
struct Stream {
  Bytes head;
  Bytes block;
  Bytes end;
};

Stream sampleStream() {
  mrpt::io::CMemoryStream memory;
  mrpt::serialization::archiveFrom(memory) << sampleMap();
  const auto* const bytes = static_cast<const std::uint8_t*>(memory.getRawBufferData());
  const std::size_t total = memory.getTotalBytesCount();
  constexpr std::size_t kSizeAndChecksum = 16;
  for (std::size_t head = 0; head + kSizeAndChecksum < total; ++head) {
    std::uint64_t size = 0;
    std::memcpy(&size, bytes + head, sizeof size);
    const std::size_t block = head + kSizeAndChecksum;
    if (size != total - block - 1) continue;
    return {Bytes(bytes, bytes + head), Bytes(bytes + block, bytes + total - 1),
            Bytes(bytes + total - 1, bytes + total)};
  }
  std::abort();  // MRPT's framing is another one
}

const Stream& sample() {
  static const Stream stream = sampleStream();
  return stream;
}

void read(const std::uint8_t* block, std::uint64_t size) {
  const std::uint64_t checksum = XXH3_64bits(block, size);
  mrpt::io::CMemoryStream memory;
  memory.Write(sample().head.data(), sample().head.size());
  memory.Write(&size, sizeof size);
  memory.Write(&checksum, sizeof checksum);
  memory.Write(block, size);
  memory.Write(sample().end.data(), sample().end.size());
  memory.Seek(0);
  csom::CSemanticContinuousMap map;
  mrpt::serialization::archiveFrom(memory) >> map;
}

}  // namespace

extern "C" int LLVMFuzzerInitialize(int* argc, char*** argv);

/// If the sample itself were refused, nothing would be tried out.
int LLVMFuzzerInitialize(int* /*argc*/, char*** /*argv*/) {
  read(sample().block.data(), sample().block.size());
  return 0;
}

/// Starts from the sample: nothing else comes as far as the voxels.
std::size_t LLVMFuzzerCustomMutator(std::uint8_t* data, std::size_t size, std::size_t max_size,
                                    unsigned /*seed*/) {
  const Bytes& block = sample().block;
  if (size < 2 && block.size() <= max_size) {
    std::memcpy(data, block.data(), block.size());
    size = block.size();
  }
  return LLVMFuzzerMutate(data, size, max_size);
}

int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  try {
    read(data, size);
  } catch (const std::bad_alloc&) {
    throw;
  } catch (const std::exception&) {
    // MRPT hands on everything that a class throws as an exception of its own.
  }
  return 0;
}
