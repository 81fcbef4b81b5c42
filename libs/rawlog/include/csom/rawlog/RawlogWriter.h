// SPDX-License-Identifier: BSD-3-Clause
// A rawlog that appears complete or not at all.
#pragma once

#include <csom/io/OutputFile.h>
#include <mrpt/serialization/CSerializable.h>

#include <memory>
#include <string>

namespace csom {

/// Writes entries, gz-compressed as MRPT does, to a file beside the target, which commit() puts in
/// its place. The same entries give the same bytes. All members throw FileError, also when the disk
/// is full. The one entry of a simplemap is the CSimpleMap.
class RawlogWriter {
 public:
  /// `compression`: zlib's level, 1 (fastest, MRPT's own) to 9 (smallest).
  explicit RawlogWriter(const std::string& file, int compression = 1);

  ~RawlogWriter();

  void write(const mrpt::serialization::CSerializable& entry);
  void commit();

 private:
  class Archive;

  std::string file_;
  OutputFile output_;
  std::unique_ptr<Archive> archive_;
};

}  // namespace csom
