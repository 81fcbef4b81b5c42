// SPDX-License-Identifier: BSD-3-Clause
// Putting texts and bytes into a page safely.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace csom {

/// Makes any bytes safe as text and inside quoted attributes; control characters become spaces.
std::string escapeHtml(const std::string& text);

/// RFC 4648, with padding, without line breaks.
std::string encodeBase64(const std::vector<std::uint8_t>& bytes);

}  // namespace csom
