// SPDX-License-Identifier: BSD-3-Clause
// Reads a rawlog or a simplemap one entry at a time.
#pragma once

#include <mrpt/obs/CActionCollection.h>
#include <mrpt/obs/CObservation.h>
#include <mrpt/poses/CPose3D.h>

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace csom {

/// One entry of a log: an observation, a sensory frame, an action, or a key frame of a simplemap.
struct RawlogEntry {
  std::size_t index = 0;  ///< position in the file, from 0; a key frame is one entry
  /// In the order of the sensory frame; empty for an action.
  std::vector<mrpt::obs::CObservation::Ptr> observations;
  mrpt::obs::CActionCollection::Ptr action;            ///< null if this is none
  std::optional<mrpt::poses::CPose3D> key_frame_pose;  ///< mean pose; simplemaps only
  std::string comment;  ///< text of a CObservationComment, which counts as no observation
};

/// How far a log could be read.
struct RawlogEnd {
  std::size_t entries = 0;  ///< entries read completely
  std::uint64_t bytes = 0;  ///< offset behind the last complete entry, decompressed
  bool complete = true;     ///< false: the file is cut off or damaged there
  std::string reason;       ///< one line, empty if complete
};

/// Takes every format that MRPT writes: observation-only and action/sensory-frame logs, a log
/// stored as one CRawlog object, simplemaps; each plain or gzip-compressed. Memory: one entry at a
/// time.
///
/// An entry so damaged that MRPT crashes reading it ends the process with exit code 1 and one line
/// on stderr, as no exception can leave such a place. That and a limit on the memory of an entry
/// are matters of the whole process: while next() runs, other threads should neither crash nor take
/// much memory. A log that has been read before needs neither.
///
/// Opening a log makes the folder of its externalised images (FILE_Images, or Images beside it)
/// MRPT's process-wide base path, so two logs with images cannot be read alternately.
class RawlogReader {
 public:
  /// Known: the log has been read up to where it will be read now, without any damage.
  enum class Soundness { Unknown, Known };

  /// Throws FileError if the file is missing, empty, a folder, or neither a rawlog nor a simplemap.
  explicit RawlogReader(const std::string& file, Soundness soundness = Soundness::Unknown);
  ~RawlogReader();
  RawlogReader(const RawlogReader&) = delete;
  RawlogReader& operator=(const RawlogReader&) = delete;

  /// The next entry; nothing at the end, or where the file is cut off or damaged (see end()).
  std::optional<RawlogEntry> next();

  /// What has been read so far; final once next() returned nothing.
  const RawlogEnd& end() const { return end_; }
  bool isSimpleMap() const;
  const std::string& file() const { return file_; }
  const std::string& imageFolder() const { return image_folder_; }

 private:
  class Archive;
  struct Guard;

  std::unique_ptr<Guard> guard() const;  ///< null if the log is known to be sound
  void readStart();
  bool readEntry(RawlogEntry& entry);
  bool accept(const std::shared_ptr<mrpt::serialization::CSerializable>& object,
              RawlogEntry& entry) const;
  std::string crashLine() const;
  void stopAt(const std::string& reason);

  std::string file_;
  std::string image_folder_;
  Soundness soundness_;
  std::uint64_t memory_allowance_ = 0;  ///< of one entry [bytes]
  std::unique_ptr<Archive> archive_;
  std::optional<RawlogEntry> first_;  ///< read when opening, to know that this is a rawlog
  /// Entries left inside an enclosing object; a log of loose objects has no such number.
  std::optional<std::uint32_t> remaining_;
  int simplemap_version_ = -1;  ///< −1: no simplemap
  bool stopped_ = false;
  RawlogEnd end_;
};

}  // namespace csom
