// SPDX-License-Identifier: BSD-3-Clause
// One section of an ini file, read strictly.
#pragma once

#include <csom/core/Error.h>
#include <csom/core/Options.h>
#include <csom/maps/LabelOptions.h>
#include <mrpt/config/CConfigFile.h>
#include <mrpt/config/CConfigFileBase.h>

#include <set>
#include <string>
#include <vector>

namespace csom {

/// Throws ConfigError if the file is not there, or if MRPT cannot make sense of it ($eval{…}).
void openIni(const std::string& file, mrpt::config::CConfigFile& ini);

/// Throws ConfigError, with both lines, if a section that is `section` or begins with it and `_` is
/// given twice in a file, or a key in such a section: MRPT takes the last value, without a word.
void requireGivenOnce(const std::string& file, const std::string& section);

/// The file behind a configuration; empty if it was read from memory.
std::string fileOf(const mrpt::config::CConfigFileBase& source);

/// Reads values of one section, and remembers which keys were asked for. Errors are ConfigErrors
/// "FILE [section] key = value …".
class IniSection {
 public:
  /// `source` must outlive the section.
  IniSection(const mrpt::config::CConfigFileBase& source, const std::string& section);

  bool has(const std::string& key);
  /// Text of a key without comment and surrounding blanks. Requires has(key).
  std::string text(const std::string& key) const;

  /// Parses the value of `key` into `value` by parse(key, text, value) if it is there.
  template <class Value>
  void read(const std::string& key, Value& value);

  /// "FILE [section]", for errors.
  std::string place() const;
  /// "FILE [section] key" of all keys that has() or read() were not asked for.
  std::vector<std::string> unreadKeys() const;

 private:
  const mrpt::config::CConfigFileBase* source_;
  std::string section_;
  std::set<std::string> read_;  ///< in lower case
};

template <class Value>
void IniSection::read(const std::string& key, Value& value) {
  if (!has(key)) return;
  try {
    parse(key, text(key), value);
  } catch (const OptionError& error) {
    throw ConfigError(place() + ": " + error.what());
  }
}

}  // namespace csom
