// SPDX-License-Identifier: BSD-3-Clause
// Figures as people read them.
#pragma once

#include <cstddef>
#include <string>

namespace csom {

/// 1234567 → "1,234,567".
std::string formatCount(std::size_t count);
/// "1 point", "2 points".
std::string formatCount(std::size_t count, const std::string& noun);
/// Three significant digits, never in exponent notation: 0.0123, 1.23, 123, 12300.
std::string formatNumber(double value);
/// "20 cm", "5 m", "2 km".
std::string formatLength(double metres);
/// "850 ms", "12.3 s", "3 min 20 s", "2 h 5 min".
std::string formatDuration(double seconds);
/// "512 bytes", "1.5 kB", "12 MB" (powers of 1000).
std::string formatBytes(std::size_t bytes);
/// 0.123 → "12.3 %"; what is not zero never shows as "0 %".
std::string formatShare(double share);

}  // namespace csom
