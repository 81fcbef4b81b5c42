// SPDX-License-Identifier: BSD-3-Clause
// Keeps a file for one process.
#include "FileLock.h"

#include <csom/core/Error.h>
#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>

namespace csom::detail {

FileLock::FileLock(const std::string& path, const std::string& shown_name)
    : descriptor_(::open(path.c_str(), O_RDWR | O_CLOEXEC)) {
  if (descriptor_ < 0)
    throw FileError(shown_name, std::string("cannot be opened: ") + std::strerror(errno));
  std::string reason;
  if (::flock(descriptor_, LOCK_EX | LOCK_NB) != 0) {
    reason = errno == EWOULDBLOCK
                 ? "is being written by another process; wait until it is done, or stop it first"
                 : std::string("cannot be locked: ") + std::strerror(errno);
  } else {
    // Whoever had it until now may have finished and removed it.
    struct stat opened {
    }, named{};
    if (::fstat(descriptor_, &opened) != 0 || ::stat(path.c_str(), &named) != 0 ||
        opened.st_ino != named.st_ino)
      reason = "has just been finished by another process";
  }
  if (reason.empty()) return;
  ::close(descriptor_);
  throw FileError(shown_name, reason);
}

FileLock::~FileLock() {
  ::close(descriptor_);
}

bool FileLock::sync() const {
  return ::fsync(descriptor_) == 0;
}

}  // namespace csom::detail
