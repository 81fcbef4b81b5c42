// SPDX-License-Identifier: BSD-3-Clause
// A map file that grows while a map is made, and survives whatever ends that.
#pragma once

#include <csom/io/MapFile.h>

#include <cstddef>
#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <string>
#include <utility>
#include <vector>

namespace csom {

/// The file of a map that is still being made. What commit() was told is in it, whole, whatever
/// happens to the process, the machine or the disk afterwards; what it was not told is not.
///
/// One process at a time has it open to write; loadMap() reads what was committed last at any time.
/// All members throw FileError. After a commit() that threw, the file is as before it, and the
/// store must not be used any more. Not thread-safe.
class MapStore {
 public:
  /// What the one who makes the map needs to go on: texts or bytes under names of its own choice.
  using State = std::map<std::string, std::string>;
  using Chunks = std::vector<std::pair<ChunkIndex, const Chunk*>>;
  /// How chunks go into the file: in place of what it has there, or on top of it. Counts are
  /// integers that are added with saturation, so a map that is written in parts is the same map.
  enum class Voxels { Replace, Add };

  /// Makes `file`, which must not exist, with the options, labels and meta of `start` (its voxels
  /// and scans are not looked at).
  static std::unique_ptr<MapStore> create(const std::string& file, const MapDocument& start,
                                          const State& state);
  /// Opens a file that create() made and nobody has finished.
  static std::unique_ptr<MapStore> open(const std::string& file);
  ~MapStore();
  MapStore(const MapStore&) = delete;
  MapStore& operator=(const MapStore&) = delete;

  /// One transaction: these chunks, the scans from number scanCount() on, and the state.
  void commit(const Chunks& chunks, Voxels voxels, const std::vector<ScanRecord>& scans,
              const State& state);

  /// Writes the map to `file` as saveMap() would, without holding it in memory. The store stays.
  void writeFinished(const std::string& file, const std::map<std::string, std::string>& meta) const;
  /// Closes the file and removes it.
  static void remove(std::unique_ptr<MapStore> store);

  const Options& options() const;
  const std::map<std::string, std::string>& meta() const;
  /// As it was committed last.
  const State& state() const;
  std::size_t scanCount() const;
  std::size_t chunkCount() const;
  std::string digest() const;

  std::vector<ScanRecord> loadScans() const;
  SemanticMap loadVoxels() const;
  /// Visits the map in parts of about `bytes` in memory, each with whole chunks.
  void forEachPart(std::size_t bytes, const std::function<void(const SemanticMap&)>& visit) const;

 private:
  class Content;
  explicit MapStore(std::unique_ptr<Content> content);
  std::unique_ptr<Content> content_;
};

/// The state of an unfinished file, for who wants to know what made it. Throws FileError if it is
/// no such file.
MapStore::State readState(const std::string& file);

}  // namespace csom
