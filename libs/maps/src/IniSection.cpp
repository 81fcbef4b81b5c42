// SPDX-License-Identifier: BSD-3-Clause
// One section of an ini file, read strictly.
#include "IniSection.h"

#include <csom/io/InputFile.h>
#include <csom/io/TextParser.h>
#include <csom/maps/MrptMessage.h>

#include <cctype>
#include <exception>
#include <filesystem>
#include <fstream>
#include <map>
#include <optional>
#include <string_view>
#include <utility>

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

/// The lines of an ini as MRPT's parser joins them: a backslash at the end of a line continues it.
class IniLines {
 public:
  explicit IniLines(const std::string& text) : lines_(text) {}

  bool next(std::string& line) {
    std::string_view part;
    if (!lines_.next(part)) return false;
    line_number_ = lines_.lineNumber();
    line = part;
    while (!line.empty() && line.back() == '\\' && lines_.next(part)) {
      line.pop_back();
      line += part;
    }
    line = trimmed(line);
    return true;
  }
  /// Of the line last read, or of its first part.
  std::size_t lineNumber() const { return line_number_; }

 private:
  detail::LineReader lines_;
  std::size_t line_number_ = 0;
};

/// Remembers where things were given.
class GivenOnce {
 public:
  GivenOnce(const std::string& file, std::string what) : file_(file), what_(std::move(what)) {}

  void add(const std::string& name, std::size_t line) {
    const auto [first, is_new] = lines_.emplace(detail::lowerCase(name), line);
    if (!is_new)
      throw ConfigError(file_ + ": " + what_ + name + " is given twice, in line " +
                        std::to_string(first->second) + " and in line " + std::to_string(line) +
                        "; remove one of them");
  }

 private:
  std::string file_;
  std::string what_;
  std::map<std::string, std::size_t> lines_;
};

}  // namespace

void requireGivenOnce(const std::string& file, const std::string& section) {
  const std::string text = detail::readFile(file);
  const std::string wanted = detail::lowerCase(section);
  IniLines lines(text);
  GivenOnce sections(file, "section ");
  std::optional<GivenOnce> keys;  // nothing in sections that are not looked at
  for (std::string line; lines.next(line);) {
    if (line.empty() || line[0] == ';' || line[0] == '#' || line.compare(0, 2, "//") == 0) continue;
    if (line[0] == '[') {
      const std::string name = trimmed(line.substr(1, line.find(']') - 1));
      const std::string lower = detail::lowerCase(name);
      keys.reset();
      if (lower != wanted && lower.compare(0, wanted.size() + 1, wanted + "_") != 0) continue;
      sections.add("[" + name + "]", lines.lineNumber());
      keys.emplace(file, "[" + name + "] ");
    } else if (const std::size_t equals = line.find('='); keys && equals != std::string::npos) {
      keys->add(trimmed(line.substr(0, equals)), lines.lineNumber());
    }
  }
}

void openIni(const std::string& file, mrpt::config::CConfigFile& ini) {
  // A pipe would keep us waiting.
  std::error_code ignored;
  if (std::filesystem::exists(file, ignored) && !std::filesystem::is_regular_file(file, ignored))
    throw ConfigError(file + ": is no regular file");
  // CConfigFile takes a missing file for an empty one.
  if (!std::ifstream(file)) throw ConfigError(file + ": no such file, or it cannot be read");
  try {
    // Not setFileName(), which reads the file without @define, ${…}, $eval{…} and $env{…}.
    ini = mrpt::config::CConfigFile(file);
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
  read_.insert(detail::lowerCase(key));
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
    if (read_.count(detail::lowerCase(key)) == 0) unread.push_back(place() + " " + key);
  }
  return unread;
}

}  // namespace csom
