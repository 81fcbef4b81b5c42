// SPDX-License-Identifier: BSD-3-Clause
// Will a program of MRPT find the semantic map in its ini file?
#pragma once

#include <string>
#include <vector>

namespace csom {

/// What is known of a program of MRPT.
struct MrptApplication {
  std::string program;  ///< name of its file
  std::string section;  ///< of the ini file, that says which maps there are; empty: it reads none
  std::string ini;      ///< read from the working folder, under this name; empty: an argument
  bool saves_maps = true;
};

/// `program`: a name or a path. Null for programs that are not known.
const MrptApplication* findApplication(const std::string& program);

/// Throws ConfigError, with place and remedy, if the program that reads `file` would make no
/// semantic map, or could not use it: MRPT passes over what it does not know, without a word.
/// `application` may be null: then it is enough that any section defines a semantic map. Returns
/// what does no harm but is probably not meant, a line each: keys and sections that nothing reads.
std::vector<std::string> checkApplicationIni(const std::string& file,
                                             const MrptApplication* application);

/// Values of `logOutput_dir`, where programs of MRPT leave their results, in any section.
std::vector<std::string> listOutputFolders(const std::string& ini_file);

}  // namespace csom
