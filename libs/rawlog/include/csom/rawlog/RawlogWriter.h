// SPDX-License-Identifier: BSD-3-Clause
// A rawlog that appears complete or not at all.
#pragma once

#include <csom/io/OutputFile.h>
#include <mrpt/io/CFileGZOutputStream.h>
#include <mrpt/serialization/CSerializable.h>

#include <string>

namespace csom {

/// Writes entries, gz-compressed as MRPT does, to a file beside the target, which commit() puts in
/// its place. The same entries give the same bytes. All members throw FileError.
class RawlogWriter {
 public:
  /// `compression`: zlib's level, 1 (fastest, MRPT's own) to 9 (smallest).
  explicit RawlogWriter(const std::string& file, int compression = 1);

  void write(const mrpt::serialization::CSerializable& entry);
  void commit();

 private:
  std::string file_;
  OutputFile output_;
  mrpt::io::CFileGZOutputStream stream_;
};

}  // namespace csom
