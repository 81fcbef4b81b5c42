// SPDX-License-Identifier: BSD-3-Clause
// Where the plug-in of this program lies.
#pragma once

#include <string>

namespace csom {

/// Absolute path of the very libcsom-maps.so that this program is running with, so that what is
/// preloaded into others is of the same version. Throws std::runtime_error if it is no file.
std::string pluginFile();

}  // namespace csom
