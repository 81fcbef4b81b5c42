// SPDX-License-Identifier: BSD-3-Clause
#include <csom/core/Error.h>
#include <csom/io/OutputFile.h>
#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <filesystem>

namespace csom {

namespace fs = std::filesystem;

namespace {

/// Creates a new file NAME.tmpN beside `target` with the permissions that umask gives.
std::string createBeside(const fs::path& target, std::unique_ptr<TemporaryPath>& temporary) {
  for (int attempt = 0;; ++attempt) {
    std::string path =
        target.string() + ".tmp" + std::to_string(::getpid()) + "-" + std::to_string(attempt);
    temporary = std::make_unique<TemporaryPath>(path);
    const int descriptor = ::open(path.c_str(), O_CREAT | O_EXCL | O_WRONLY | O_CLOEXEC, 0666);
    if (descriptor >= 0) {
      ::close(descriptor);
      return path;
    }
    if (errno != EEXIST)
      throw FileError(target.string(), std::string("cannot be written: ") + std::strerror(errno));
  }
}

/// Flushes a file or folder to the disk.
bool syncToDisk(const std::string& path, int flags) {
  const int descriptor = ::open(path.c_str(), flags | O_CLOEXEC);
  if (descriptor < 0) return false;
  const bool synced = ::fsync(descriptor) == 0;
  const int reason = errno;
  ::close(descriptor);
  errno = reason;
  return synced;
}

}  // namespace

OutputFile::OutputFile(const std::string& target) : target_(target) {
  std::error_code error;
  const fs::path resolved = fs::weakly_canonical(target, error);
  if (!error) target_ = resolved.string();
  const auto status = fs::status(target_, error);
  if (fs::is_directory(status)) throw FileError(target, "is a folder; name a file in it");
  const bool direct = fs::exists(status) && !fs::is_regular_file(status);
  path_ = direct ? target_ : createBeside(target_, temporary_);
}

OutputFile::~OutputFile() {
  if (stream_ != nullptr) std::fclose(stream_);
  if (!committed_ && !isDirect()) ::unlink(path_.c_str());
}

void OutputFile::fail(const char* action) const {
  const int reason = errno;
  throw FileError(target_, std::string(action) + ": " + std::strerror(reason));
}

void OutputFile::write(const void* bytes, std::size_t size) {
  if (stream_ == nullptr) {
    stream_ = std::fopen(path_.c_str(), "wbe");
    if (stream_ == nullptr) fail("cannot be opened for writing");
  }
  if (std::fwrite(bytes, 1, size, stream_) != size) fail("cannot be written");
}

void OutputFile::closeStream() {
  if (stream_ == nullptr) return;
  std::FILE* stream = stream_;
  stream_ = nullptr;
  if (std::fclose(stream) != 0) fail("cannot be written");
}

void OutputFile::commit() {
  closeStream();
  if (!isDirect()) {
    if (!syncToDisk(path_, O_RDONLY)) fail("cannot be flushed to the disk");
    if (std::rename(path_.c_str(), target_.c_str()) != 0) fail("cannot be replaced");
    // The rename is durable once the folder is flushed; a file system that cannot do that has
    // nothing better to offer.
    syncToDisk(fs::path(target_).parent_path().string(), O_RDONLY | O_DIRECTORY);
  }
  committed_ = true;
  temporary_.reset();
}

}  // namespace csom
