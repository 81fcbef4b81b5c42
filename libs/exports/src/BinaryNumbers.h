// SPDX-License-Identifier: BSD-3-Clause
// Numbers as little-endian bytes.
#pragma once

#include <array>
#include <cstddef>
#include <cstring>

namespace csom::detail {

/// Writes numbers one after the other to anything that has write(bytes, size).
template <class Output, class... Numbers>
void writeBinary(Output& out, Numbers... numbers) {
  static_assert(__BYTE_ORDER__ == __ORDER_LITTLE_ENDIAN__, "the formats are little-endian");
  std::array<char, (sizeof(Numbers) + ...)> bytes;
  std::size_t at = 0;
  ((std::memcpy(bytes.data() + at, &numbers, sizeof numbers), at += sizeof numbers), ...);
  out.write(bytes.data(), bytes.size());
}

}  // namespace csom::detail
