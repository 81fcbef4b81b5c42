// SPDX-License-Identifier: BSD-3-Clause
#include "OutputPaths.h"

#include <csom/core/Error.h>

#include <filesystem>
#include <system_error>

namespace csom {

namespace fs = std::filesystem;

namespace {

bool isSameFile(const std::string& a, const std::string& b) {
  std::error_code error;
  if (fs::exists(a, error) && fs::exists(b, error)) {
    // Devices and pipes may be named as often as one likes.
    return fs::is_regular_file(a, error) && fs::equivalent(a, b, error);
  }
  return fs::weakly_canonical(a, error) == fs::weakly_canonical(b, error);
}

}  // namespace

void requireSeparateOutputs(const std::vector<std::string>& outputs,
                            const std::vector<std::string>& inputs) {
  for (std::size_t i = 0; i < outputs.size(); ++i) {
    if (outputs[i].empty()) throw ConfigError("the name of an output is empty");
    for (const std::string& input : inputs) {
      if (!input.empty() && isSameFile(outputs[i], input))
        throw ConfigError(outputs[i] + " is an input of this command; write to another file");
    }
    for (std::size_t j = 0; j < i; ++j) {
      if (isSameFile(outputs[i], outputs[j]))
        throw ConfigError(outputs[i] + " is named for two outputs; give each a file of its own");
    }
  }
}

}  // namespace csom
