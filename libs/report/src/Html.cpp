// SPDX-License-Identifier: BSD-3-Clause
// HTML escaping, colours and base64.
#include <csom/report/Html.h>

#include <cstdio>

namespace csom {

std::string escapeHtml(const std::string& text) {
  std::string escaped;
  escaped.reserve(text.size());
  for (const char c : text) {
    const auto byte = static_cast<unsigned char>(c);
    switch (c) {
      case '&':
        escaped += "&amp;";
        break;
      case '<':
        escaped += "&lt;";
        break;
      case '>':
        escaped += "&gt;";
        break;
      case '"':
        escaped += "&quot;";
        break;
      case '\'':
        escaped += "&#39;";
        break;
      case '\n':
        escaped += '\n';
        break;
      default:
        escaped += byte < 0x20 || byte == 0x7f ? ' ' : c;
    }
  }
  return escaped;
}

std::string dataElement(const std::string& json, const std::string& id) {
  std::string html = "<script type=\"application/json\"";
  if (!id.empty()) html += " id=\"" + id + "\"";
  html += ">";
  // In JSON this character can only be part of a string.
  for (const char c : json) html += c == '<' ? std::string("\\u003c") : std::string(1, c);
  return html + "</script>\n";
}

std::string cssColor(const Color& color) {
  char text[8];
  std::snprintf(text, sizeof text, "#%02x%02x%02x", color[0], color[1], color[2]);
  return text;
}

std::string encodeBase64(const std::vector<std::uint8_t>& bytes) {
  static constexpr char kDigits[] =
      "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string text;
  text.reserve((bytes.size() + 2) / 3 * 4);
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    const auto byte = [&](std::size_t offset) {
      return i + offset < bytes.size() ? std::uint32_t{bytes[i + offset]} : 0u;
    };
    const std::uint32_t group = byte(0) << 16 | byte(1) << 8 | byte(2);
    text += kDigits[group >> 18];
    text += kDigits[group >> 12 & 63];
    text += i + 1 < bytes.size() ? kDigits[group >> 6 & 63] : '=';
    text += i + 2 < bytes.size() ? kDigits[group & 63] : '=';
  }
  return text;
}

}  // namespace csom
