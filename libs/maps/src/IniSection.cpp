// SPDX-License-Identifier: BSD-3-Clause
// One section of an ini file, read strictly.
#include "IniSection.h"

#include <csom/maps/MrptMessage.h>

#include <algorithm>
#include <cctype>
#include <exception>
#include <fstream>

namespace csom {
namespace {

std::string trimmed(const std::string& text) {
  constexpr char kBlanks[] = " \t\r\n";
  const std::size_t first = text.find_first_not_of(kBlanks);
  if (first == std::string::npos) return {};
  return text.substr(first, text.find_last_not_of(kBlanks) - first + 1);
}

/// Comments begin at the start of the value or after a blank, with // ; or #.
std::string withoutComment(const std::string& text) {
  for (std::size_t i = 0; i < text.size(); ++i) {
    const bool may_begin = i == 0 || std::isspace(static_cast<unsigned char>(text[i - 1])) != 0;
    if (!may_begin) continue;
    if (text[i] == ';' || text[i] == '#' || text.compare(i, 2, "//") == 0) return text.substr(0, i);
  }
  return text;
}

}  // namespace

std::string lowerCase(std::string text) {
  std::transform(text.begin(), text.end(), text.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return text;
}

void openIni(const std::string& file, mrpt::config::CConfigFile& ini) {
  // CConfigFile takes a missing file for an empty one.
  if (!std::ifstream(file)) throw ConfigError(file + ": no such file, or it cannot be read");
  try {
    ini.setFileName(file);
  } catch (const std::exception& error) {
    throw ConfigError(file + ": MRPT cannot read this ini: " + detail::messageOf(error));
  }
}

std::string fileOf(const mrpt::config::CConfigFileBase& source) {
  const auto* file = dynamic_cast<const mrpt::config::CConfigFile*>(&source);
  return file == nullptr ? std::string() : file->getAssociatedFile();
}

IniSection::IniSection(const mrpt::config::CConfigFileBase& source, const std::string& section)
    : source_(&source), section_(section) {}

bool IniSection::has(const std::string& key) {
  read_.insert(lowerCase(key));
  return source_->keyExists(section_, key);
}

std::string IniSection::text(const std::string& key) const {
  return trimmed(withoutComment(source_->read_string(section_, key, "")));
}

std::string IniSection::place() const {
  const std::string file = fileOf(*source_);
  return (file.empty() ? std::string("ini") : file) + " [" + section_ + "]";
}

std::vector<std::string> IniSection::unreadKeys() const {
  std::vector<std::string> keys;
  source_->getAllKeys(section_, keys);
  std::vector<std::string> unread;
  for (const std::string& key : keys) {
    if (read_.count(lowerCase(key)) == 0) unread.push_back(place() + " " + key);
  }
  return unread;
}

}  // namespace csom
