// SPDX-License-Identifier: BSD-3-Clause
// Whole files: in memory, or as a hash.
#pragma once

#include <string>

namespace csom::detail {

/// Throws FileError if there is no such file or it is a folder, a device or a pipe.
void requireRegularFile(const std::string& file);

/// The bytes of a regular file. Throws FileError.
std::string readFile(const std::string& file);

/// XXH3 (64 bits) of the bytes of a regular file, 16 hexadecimal digits. Throws FileError.
std::string fileHash(const std::string& file);

}  // namespace csom::detail
