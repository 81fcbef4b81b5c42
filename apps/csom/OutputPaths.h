// SPDX-License-Identifier: BSD-3-Clause
// Keeps a command from writing over what it reads.
#pragma once

#include <string>
#include <vector>

namespace csom {

/// Throws ConfigError if an output is empty, is one of the inputs, or is another output: links and
/// different spellings of a path are seen through. Empty names among the inputs do not count.
void requireSeparateOutputs(const std::vector<std::string>& outputs,
                            const std::vector<std::string>& inputs);

}  // namespace csom
