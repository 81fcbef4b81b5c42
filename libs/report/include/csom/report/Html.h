// SPDX-License-Identifier: BSD-3-Clause
// Putting texts and bytes into a page safely.
#pragma once

#include <csom/io/LabelSet.h>

#include <cstdint>
#include <string>
#include <vector>

namespace csom {

/// Makes any bytes safe as text and inside quoted attributes; control characters become spaces.
std::string escapeHtml(const std::string& text);

/// A <script> that is no script but JSON for one: nothing in it can end the element. `id` may be
/// empty.
std::string dataElement(const std::string& json, const std::string& id = "");

/// "#c80000".
std::string cssColor(const Color& color);

/// RFC 4648, with padding, without line breaks.
std::string encodeBase64(const std::vector<std::uint8_t>& bytes);

}  // namespace csom
