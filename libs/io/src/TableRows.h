// SPDX-License-Identifier: BSD-3-Clause
// The rows that lie in the pages of a SQLite file, found without its trees.
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

namespace csom::detail {

/// A value as a row stores it.
struct RowValue {
  enum class Kind { Null, Integer, Real, Bytes };  ///< Bytes: a text or a blob
  Kind kind = Kind::Null;
  std::int64_t integer = 0;
  double real = 0;
  std::string bytes;
};
using TableRow = std::vector<RowValue>;

/// Calls visit(row id, row) for whatever looks like a row of a table, in the order of pages: SQLite
/// reads no row behind a damaged page, although the row itself may be sound. The caller must know
/// real rows by their hashes. Rows of more than `max_bytes` are passed over. Throws FileError if
/// the file cannot be read.
void forEachTableRow(const std::string& file, std::size_t max_bytes,
                     const std::function<void(std::int64_t, const TableRow&)>& visit);

}  // namespace csom::detail
