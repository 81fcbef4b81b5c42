// SPDX-License-Identifier: BSD-3-Clause
// Whether the write-ahead log beside a map file is whole.
#pragma once

#include <string>

namespace csom::detail {

/// What is wrong with a log of SQLite, in a line; empty if it is whole. SQLite itself passes over
/// all that lies behind the first damaged byte, without a word. Throws FileError if it cannot be
/// read.
std::string damageOfLog(const std::string& log);

}  // namespace csom::detail
