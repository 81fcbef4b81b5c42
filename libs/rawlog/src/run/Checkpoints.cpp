// SPDX-License-Identifier: BSD-3-Clause
// Decides when a run commits, and what.
#include "run/Checkpoints.h"

#include <csom/core/Error.h>
#include <malloc.h>
#include <mrpt/system/os.h>
#include <opencv2/core/version.hpp>

#include <algorithm>
#include <stdexcept>
#include <utility>

namespace csom::detail {
namespace {

/// Asking the system for its memory takes longer than a small scan.
constexpr auto kBetweenLooks = std::chrono::milliseconds(100);

/// The scan at hand may add so much to what is there before anybody looks, and a commit needs some.
constexpr std::size_t kForOneScan = 48'000'000;

/// What a scan needs for a moment is many megabytes: given back at once, not kept for the next one.
void keepNoFreedMemory() {
  constexpr int kLargeBlock = 1 << 18;
  constexpr int kMaxKept = 1 << 22;
  mallopt(M_MMAP_THRESHOLD, kLargeBlock);
  mallopt(M_TRIM_THRESHOLD, kMaxKept);
}

std::string savedScans(std::size_t count) {
  return std::to_string(count) + (count == 1 ? " scan is" : " scans are") + " saved";
}

}  // namespace

Checkpoints::Checkpoints(const CheckpointRequest& request, const MappingRequest& mapping,
                         CSemanticContinuousMap::Ptr& map, MappingState& state)
    : request_(request) {
  if (request_.max_memory) keepNoFreedMemory();
  writeInputs(mapping, map->labelOptions, constant_);
  if (request_.resume) {
    resume(map, state);
    return;
  }
  write(mapping, constant_);
  for (const auto& [key, value] : request_.notes) constant_["note." + key] = value;
  begin(*map);
}

void Checkpoints::begin(const CSemanticContinuousMap& map) {
  MapDocument start;
  start.map = SemanticMap(map.map().options());
  start.labels = map.labels();
  start.meta = request_.meta;
  for (const auto& [key, value] : constant_) {
    if (key.rfind("input.", 0) == 0 || key == "config.text") start.meta[key] = value;
  }
  start.meta["library.mrpt"] = mrpt::system::MRPT_getVersion();
  start.meta["library.opencv"] = CV_VERSION;
  MapStore::State first = constant_;
  write(MappingState{}, first);
  first["map"] = bytesOf(map);
  store_ = MapStore::create(request_.file, start, first);
}

void Checkpoints::resume(CSemanticContinuousMap::Ptr& map, MappingState& state) {
  store_ = MapStore::open(request_.file);
  const MapStore::State& then = store_->state();
  requireSameInputs(then, constant_, request_.file);
  for (const auto& [key, value] : then) {
    if (key.rfind("request.", 0) == 0 || key.rfind("note.", 0) == 0) constant_[key] = value;
  }
  state = readMappingState(then, request_.file);
  const auto bytes = then.find("map");
  if (bytes == then.end())
    throw FileError(request_.file, "table resume has no key map; map the logs again");
  const CSemanticContinuousMap::Ptr before = mapFromBytes(bytes->second, request_.file);
  if (!(before->labels() == map->labels()) ||
      !mergeable(before->map().options(), map->map().options()))
    throw FileError(request_.file,
                    "its label set is not the one that the ini names now; put that back, or remove "
                    "the file and begin anew");
  before->warn_of_damaged = map->warn_of_damaged;
  // The networks are loaded already, and where labels are kept is not for the file to say.
  before->takeLabelSourcesOf(*map);
  map = before;
  // With little memory all voxels stay in the file.
  in_parts_ = request_.max_memory.has_value();
  SemanticMap voxels = in_parts_ ? SemanticMap(store_->options()) : store_->loadVoxels();
  map->replaceContent(std::move(voxels), store_->loadScans());
  committed_ = map->map().chunks();
}

MapStore::Chunks Checkpoints::changedChunks(const ChunkStore& chunks) const {
  MapStore::Chunks changed;
  for (const auto& [index, chunk] : chunks.sorted()) {
    if (committed_.find(index) != chunk) changed.emplace_back(index, chunk);
  }
  return changed;
}

void Checkpoints::commit(CSemanticContinuousMap& map, const MappingState& state) {
  MapStore::State now = constant_;
  write(state, now);
  now["map"] = bytesOf(map);
  const ChunkStore& chunks = map.map().chunks();
  if (in_parts_)
    store_->commit(chunks.sorted(), MapStore::Voxels::Add, map.scans(), now);
  else
    store_->commit(changedChunks(chunks), MapStore::Voxels::Replace, map.scans(), now);
  const bool drop = in_parts_ || needsRoom(map);
  in_parts_ = drop;
  committed_ = drop ? ChunkStore() : chunks;
  if (drop) {
    map.replaceContent(SemanticMap(map.map().options()), map.scans());
    // Chunks are many small pieces; without this the process keeps their memory.
    malloc_trim(0);
  }
  last_commit_ = Clock::now();
}

bool Checkpoints::needsRoom(const CSemanticContinuousMap& map) const {
  if (!request_.max_memory) return false;
  const std::size_t most = *request_.max_memory;
  const std::size_t room = most - std::min(most / 3 * 2, kForOneScan);
  // As long as all voxels are in memory, those of the last commit may be there a second time.
  return map.map().memoryBytes() > room / (in_parts_ ? 1 : 2);
}

std::optional<std::string> Checkpoints::memoryShortage() {
  const auto now = Clock::now();
  if (!request_.memory_shortage || now - last_look_ < kBetweenLooks) return std::nullopt;
  last_look_ = now;
  return request_.memory_shortage();
}

void Checkpoints::afterEntry(CSemanticContinuousMap& map, const MappingState& state) {
  const std::chrono::duration<double> elapsed = Clock::now() - last_commit_;
  const bool stop = request_.stop && request_.stop();
  const auto shortage = memoryShortage();
  if (stop || shortage || needsRoom(map) || elapsed.count() >= request_.seconds) commit(map, state);
  if (stop) throw Interrupted("stopped; " + savedScans(scansCommitted()));
  if (shortage)
    throw Error("memory is short: " + *shortage + "; " + savedScans(scansCommitted()) +
                    ", and the rest can be mapped with less",
                {"max-memory"});
}

void Checkpoints::discardIfEmpty() {
  if (store_ && store_->scanCount() == 0) MapStore::remove(std::move(store_));
}

}  // namespace csom::detail
