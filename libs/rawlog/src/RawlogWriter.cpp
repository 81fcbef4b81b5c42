// SPDX-License-Identifier: BSD-3-Clause
// A rawlog that appears complete or not at all.
#include <csom/core/Error.h>
#include <csom/rawlog/RawlogWriter.h>
#include <mrpt/serialization/CArchive.h>

#include "MrptText.h"

namespace csom {

RawlogWriter::RawlogWriter(const std::string& file, int compression) : file_(file), output_(file) {
  if (!stream_.open(output_.path(), compression))
    throw FileError(file, "cannot be opened for writing");
}

void RawlogWriter::write(const mrpt::serialization::CSerializable& entry) {
  try {
    mrpt::serialization::archiveFrom(stream_) << entry;
  } catch (const std::exception& error) {
    throw FileError(file_, "cannot be written: " + detail::oneLine(error));
  }
}

void RawlogWriter::commit() {
  stream_.close();
  output_.commit();
}

}  // namespace csom
