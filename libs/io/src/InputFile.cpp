// SPDX-License-Identifier: BSD-3-Clause

#include <csom/core/Error.h>
#include <csom/io/InputFile.h>

#include <cerrno>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <vector>

#include "MapHashes.h"

namespace csom::detail {

void requireRegularFile(const std::string& file) {
  std::error_code error;
  const auto status = std::filesystem::status(file, error);
  if (status.type() == std::filesystem::file_type::not_found) throw FileError(file, "no such file");
  if (std::filesystem::is_directory(status)) throw FileError(file, "is a folder, not a file");
  // A device or a pipe has no size against which length fields could be checked.
  if (!std::filesystem::is_regular_file(status)) throw FileError(file, "is not a regular file");
}

std::string readFile(const std::string& file) {
  requireRegularFile(file);
  std::error_code error;
  errno = 0;
  std::ifstream stream(file, std::ios::binary);
  if (!stream) throw FileError(file, std::string("cannot be opened: ") + std::strerror(errno));
  std::string bytes(static_cast<std::size_t>(std::filesystem::file_size(file, error)), '\0');
  stream.read(bytes.data(), static_cast<std::streamsize>(bytes.size()));
  if (error || !stream) throw FileError(file, "cannot be read to its end");
  return bytes;
}

std::string fileHash(const std::string& file) {
  requireRegularFile(file);
  errno = 0;
  std::ifstream stream(file, std::ios::binary);
  if (!stream) throw FileError(file, std::string("cannot be opened: ") + std::strerror(errno));
  Hasher hasher;
  std::vector<char> piece(std::size_t{1} << 20U);
  while (stream) {
    stream.read(piece.data(), static_cast<std::streamsize>(piece.size()));
    hasher.add(piece.data(), static_cast<std::size_t>(stream.gcount()));
  }
  if (!stream.eof()) throw FileError(file, "cannot be read to its end");
  return hexadecimal(hasher.value());
}

}  // namespace csom::detail
