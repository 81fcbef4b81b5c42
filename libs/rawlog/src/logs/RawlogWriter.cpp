// SPDX-License-Identifier: BSD-3-Clause
// A rawlog that appears complete or not at all.
#include <csom/core/Error.h>
#include <csom/rawlog/RawlogWriter.h>
#include <mrpt/serialization/CArchive.h>
#include <zlib.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <stdexcept>

#include "logs/MrptText.h"

namespace csom {

/// What MRPT's CFileGZOutputStream writes. That one says nothing of a disk that is full when the
/// file is closed, and most of a small log is written only then.
class RawlogWriter::Archive : public mrpt::serialization::CArchive {
 public:
  Archive(const std::string& file, int compression)
      : stream_(::gzopen(file.c_str(), ("wb" + std::to_string(compression)).c_str())) {}
  ~Archive() override {
    if (stream_ != nullptr) ::gzclose(stream_);
  }

  bool isOpen() const { return stream_ != nullptr; }

  void close() {
    errno = 0;
    const int result = ::gzclose(stream_);
    stream_ = nullptr;
    if (result != Z_OK) throw std::runtime_error(reason());
  }

 protected:
  std::size_t write(const void* buffer, std::size_t size) override {
    constexpr std::size_t kLargestPiece = std::size_t{1} << 30;  // zlib's sizes are 32 bits
    const auto* bytes = static_cast<const char*>(buffer);
    for (std::size_t done = 0; done < size;) {
      const std::size_t piece = std::min(size - done, kLargestPiece);
      errno = 0;
      if (::gzwrite(stream_, bytes + done, static_cast<unsigned>(piece)) <= 0)
        throw std::runtime_error(reason());
      done += piece;
    }
    return size;
  }
  std::size_t read(void*, std::size_t) override {
    throw std::logic_error("a rawlog is only written");
  }

 private:
  static std::string reason() { return errno != 0 ? std::strerror(errno) : "compression failed"; }

  gzFile stream_;
};

RawlogWriter::RawlogWriter(const std::string& file, int compression)
    : file_(file), output_(file), archive_(std::make_unique<Archive>(output_.path(), compression)) {
  if (!archive_->isOpen()) throw FileError(file, "cannot be opened for writing");
}

RawlogWriter::~RawlogWriter() = default;

void RawlogWriter::write(const mrpt::serialization::CSerializable& entry) {
  try {
    *archive_ << entry;
  } catch (const std::exception& error) {
    throw FileError(file_, "cannot be written: " + detail::oneLine(error));
  }
}

void RawlogWriter::commit() {
  try {
    archive_->close();
  } catch (const std::exception& error) {
    throw FileError(file_, std::string("cannot be written: ") + error.what());
  }
  output_.commit();
}

}  // namespace csom
