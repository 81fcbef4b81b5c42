// SPDX-License-Identifier: BSD-3-Clause
// Decides when a run commits, and what.
#pragma once

#include <csom/rawlog/CheckpointRequest.h>
#include <csom/rawlog/MappingRun.h>

#include <chrono>
#include <memory>

#include "run/MappingState.h"

namespace csom::detail {

/// The voxels of the map object are all voxels, and chunks that have changed replace those of the
/// file; or, from where they take more than max_memory, they are what has been added since the last
/// commit, and are added to the file.
class Checkpoints {
 public:
  /// Makes the file, or opens it and brings `map` and `state` to where the run was left.
  Checkpoints(const CheckpointRequest& request, const MappingRequest& mapping,
              CSemanticContinuousMap::Ptr& map, MappingState& state);

  /// To be called when a scan is whole. Throws Interrupted, and std::runtime_error where memory is
  /// short, with all committed.
  void afterEntry(CSemanticContinuousMap& map, const MappingState& state);
  void commit(CSemanticContinuousMap& map, const MappingState& state);

  bool voxelsInMemory() const { return !in_parts_; }
  std::size_t scansCommitted() const { return store_->scanCount(); }
  std::size_t chunksCommitted() const { return store_->chunkCount(); }
  std::unique_ptr<MapStore> release() { return std::move(store_); }
  /// Removes the file if nothing is lost with it.
  void discardIfEmpty();

 private:
  using Clock = std::chrono::steady_clock;

  void begin(const CSemanticContinuousMap& map);
  void resume(CSemanticContinuousMap::Ptr& map, MappingState& state);
  MapStore::Chunks changedChunks(const ChunkStore& chunks) const;
  bool needsRoom(const CSemanticContinuousMap& map) const;
  std::optional<std::string> memoryShortage();

  const CheckpointRequest& request_;
  MapStore::State constant_;  ///< the part of the state that never changes
  std::unique_ptr<MapStore> store_;
  /// The voxels as they were committed last: they share all chunks that have not changed since.
  ChunkStore committed_;
  bool in_parts_ = false;
  Clock::time_point last_commit_ = Clock::now();
  Clock::time_point last_look_ = Clock::now();
};

}  // namespace csom::detail
