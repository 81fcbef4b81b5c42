// SPDX-License-Identifier: BSD-3-Clause
// Rounding and units for people.
#include <csom/report/Format.h>

#include <algorithm>
#include <cmath>
#include <cstdio>

namespace csom {

namespace {

std::string fixed(double value, int decimals) {
  char text[400];  // the largest double has 309 digits before the point
  std::snprintf(text, sizeof text, "%.*f", decimals, value);
  return text;
}

std::string withoutTrailingZeros(std::string text) {
  if (text.find('.') == std::string::npos) return text;
  text.erase(text.find_last_not_of('0') + 1);
  if (text.back() == '.') text.pop_back();
  return text;
}

}  // namespace

std::string formatCount(std::size_t count) {
  std::string text = std::to_string(count);
  for (std::size_t end = text.size(); end > 3;) text.insert(end -= 3, ",");
  return text;
}

std::string formatCount(std::size_t count, const std::string& noun) {
  return formatCount(count) + " " + noun + (count == 1 ? "" : "s");
}

std::string formatNumber(double value) {
  if (!std::isfinite(value)) return "–";
  if (value == 0) return "0";
  const int magnitude = static_cast<int>(std::floor(std::log10(std::abs(value))));
  // Digits before the point are rounded here, those after it by printf; 1e15 is past all figures.
  if (magnitude >= 2 && magnitude < 15) {
    const double unit = std::pow(10.0, magnitude - 2);
    return fixed(std::round(value / unit) * unit, 0);
  }
  if (magnitude >= 15) return fixed(value, 0);
  return withoutTrailingZeros(fixed(value, std::min(2 - magnitude, 12)));
}

std::string formatLength(double metres) {
  if (metres >= 1000) return formatNumber(metres / 1000) + " km";
  if (metres < 1) return formatNumber(metres * 100) + " cm";
  return formatNumber(metres) + " m";
}

std::string formatDuration(double seconds) {
  if (!std::isfinite(seconds)) return "–";
  if (seconds < 1) return formatNumber(seconds * 1000) + " ms";
  if (seconds < 60) return formatNumber(seconds) + " s";
  const auto whole = static_cast<long>(std::lround(seconds));
  if (whole < 3600) return std::to_string(whole / 60) + " min " + std::to_string(whole % 60) + " s";
  return std::to_string(whole / 3600) + " h " + std::to_string(whole % 3600 / 60) + " min";
}

std::string formatBytes(std::size_t bytes) {
  if (bytes < 1000) return formatCount(bytes, "byte");
  double value = static_cast<double>(bytes);
  const char* unit = "";
  for (const char* larger : {"kB", "MB", "GB", "TB"}) {
    if (value < 1000) break;
    value /= 1000;
    unit = larger;
  }
  return formatNumber(value) + " " + unit;
}

std::string formatShare(double share) {
  if (share > 0 && share < 0.0001) return "< 0.01 %";
  return formatNumber(share * 100) + " %";
}

}  // namespace csom
