// SPDX-License-Identifier: BSD-3-Clause
// A checksum at the end of every page of a finished file: no byte changes unnoticed.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

namespace csom::detail {

constexpr std::size_t kPageSize = 4096;
/// Bytes at the end of a page that SQLite leaves to us.
constexpr std::size_t kSealSize = 8;

/// Writes into the last bytes of each page the hash of the others. For a file that nobody has open.
/// `shown_name` stands in errors. Throws FileError.
void sealPages(const std::string& path, const std::string& shown_name);

/// What is wrong, a line each: pages that are not as they were sealed.
std::vector<std::string> checkSeals(const std::string& file);

}  // namespace csom::detail
