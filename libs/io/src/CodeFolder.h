// SPDX-License-Identifier: BSD-3-Clause
// Where this program lies, whose files are found from there.
#pragma once

#include <filesystem>

namespace csom::detail {

/// The folder of the library or program that holds this code; empty if unknown.
std::filesystem::path folderOfThisCode();

}  // namespace csom::detail
